// Several requests of which some are refused.
#pragma once
#include <exception>

#include "pliant/error.h"

namespace pliant::api {

/// A refusal does not keep the other requests from being made; the first one is thrown when all have been attempted.
class FirstRefusal {
 public:
  /// Makes a request. Returns false if it was refused. Errors of the device and internal ones are thrown at once.
  template <class Make>
  bool attempt(const Make& make) {
    try {
      make();
      return true;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
      if (first_ == nullptr) first_ = std::current_exception();
      return false;
    }
  }
  void rethrow() const {
    if (first_ != nullptr) std::rethrow_exception(first_);
  }

 private:
  std::exception_ptr first_;
};

}  // namespace pliant::api
