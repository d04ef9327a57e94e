//! glTF scenes for Arealight.
