// Whether kernels can be compared with their twins here.
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>

#include "backends/opencl/opencl_backend.h"

namespace pliant::test {

/// Whether there is an OpenCL device; the devices are listed once per process. Where PLIANT_REQUIRE_OPENCL is set, as ./dev
/// test sets it, asking without one is a failure: the test that asks would be skipped, and nobody would notice.
inline bool has_opencl() {
  static const bool any = !list_opencl_devices(false).empty();
  if (!any && std::getenv("PLIANT_REQUIRE_OPENCL") != nullptr) {
    ADD_FAILURE() << "there is no OpenCL device, and PLIANT_REQUIRE_OPENCL is set";
  }
  return any;
}

}  // namespace pliant::test
