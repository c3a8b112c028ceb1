// What every call of the C API that fills in a struct has to do with its size.
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "api/c_structs.h"
#include "pliant/c/pliant.h"

namespace pliant::test {

/// A struct and what a later version may have added to it.
template <class T>
struct Later {
  T known;
  unsigned char more[24];
};

/// Every call that fills in a struct refuses sizes that no version has, and does nothing.
template <class T, class Call>
void expect_checked(T given, Call&& call) {
  const T before = given;
  for (const std::size_t size : {std::size_t{0}, api::CStruct<T>::first_size - 1, std::size_t{4097}, ~std::size_t{0}}) {
    given.size = size;
    EXPECT_EQ(call(&given), PLIANT_USAGE) << api::CStruct<T>::name << " " << size;
    const std::string message = pliant_last_error();
    EXPECT_NE(message.find(std::string(api::CStruct<T>::name) + "::size is " + std::to_string(size)), std::string::npos)
        << message;
    given.size = before.size;
    EXPECT_EQ(std::memcmp(&given, &before, sizeof(T)), 0) << "nothing was written";
  }
  Later<T> later;
  std::memset(&later, 0xee, sizeof later);
  later.known = given;
  EXPECT_EQ(call(&later.known), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(later.known.size, sizeof(T));
  for (const unsigned char byte : later.more) EXPECT_EQ(byte, 0xee) << "beyond size";
  later.known.size = sizeof later;
  EXPECT_EQ(call(&later.known), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(later.known.size, sizeof later);
  for (const unsigned char byte : later.more) EXPECT_EQ(byte, 0) << "not known to this library";
}

}  // namespace pliant::test
