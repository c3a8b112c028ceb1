// The message of an expected Error.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "pliant/error.h"

namespace pliant::test {

/// The message of the Error that `run` throws; empty if it throws none. The test fails unless the Error blames the input.
template <class Run>
std::string error_of(Run&& run) {
  try {
    run();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input) << error.what();
    return error.what();
  }
  return "";
}

}  // namespace pliant::test
