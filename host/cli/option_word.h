// The value that a word given to an option stands for.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cli/cli.h"
#include "pliant/error.h"
#include "scene/keys.h"

namespace pliant::cli {

/// Throws Error with the words that are allowed, and the one that was probably meant.
template <class Value>
Value value_of(const char* option, const std::string& word, const Words<Value>& words) {
  const auto place = std::find_if(words.begin(), words.end(), [&](const Word<Value>& w) { return w.word == word; });
  if (place != words.end()) return place->value;
  const std::vector<std::string> known = words_only(words);
  throw Error(ErrorCode::bad_input,
              fmt::format("{}: got \"{}\"; allowed are {}{}", option, word, listed(known), did_you_mean(word, known)));
}

}  // namespace pliant::cli
