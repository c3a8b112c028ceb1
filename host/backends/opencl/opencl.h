// The OpenCL bindings, and the translation of their errors. Private to this folder.
#pragma once
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wextra"
#include <CL/opencl.hpp>
#pragma GCC diagnostic pop

#include <string>

#include "pliant/error.h"

namespace pliant::opencl {

/// "CL_OUT_OF_RESOURCES", or the number.
std::string error_name(cl_int code);

/// "clEnqueueWriteBuffer failed with CL_OUT_OF_RESOURCES (-5) on opencl:0 (...)".
Error translate(const cl::Error& error, ErrorCode code, const std::string& where);

/// Runs `call` and converts OpenCL exceptions to Error; `where` names the device and the operation.
template <class Call>
auto guarded(ErrorCode code, const std::string& where, Call&& call) -> decltype(call()) {
  try {
    return call();
  } catch (const cl::Error& error) {
    throw translate(error, code, where);
  }
}

}  // namespace pliant::opencl
