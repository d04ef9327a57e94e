//! The small engine that the tools, tests and benchmarks embed Arealight in.
