# find_package(arealight) gives the targets arealight::arealight (shared) and arealight::static.
get_filename_component(_arealight_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

if(NOT TARGET arealight::arealight)
    add_library(arealight::arealight SHARED IMPORTED)
    set_target_properties(arealight::arealight PROPERTIES
        IMPORTED_LOCATION "${_arealight_prefix}/lib/libarealight_capi${CMAKE_SHARED_LIBRARY_SUFFIX}"
        IMPORTED_NO_SONAME ON
        INTERFACE_INCLUDE_DIRECTORIES "${_arealight_prefix}/include")

    find_package(Threads REQUIRED)
    add_library(arealight::static STATIC IMPORTED)
    set_target_properties(arealight::static PROPERTIES
        IMPORTED_LOCATION "${_arealight_prefix}/lib/libarealight_capi.a"
        INTERFACE_INCLUDE_DIRECTORIES "${_arealight_prefix}/include"
        INTERFACE_LINK_LIBRARIES "Threads::Threads;${CMAKE_DL_LIBS};m")
endif()
unset(_arealight_prefix)
