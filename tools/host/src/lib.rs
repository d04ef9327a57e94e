//! The Vulkan host of the tools, tests and benchmarks.
