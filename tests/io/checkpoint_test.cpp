#include "io/checkpoint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>

#include "pliant/error.h"
#include "program/hash.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using test::bytes_of;
using test::TempFolder;

Checkpoint sample() {
  Checkpoint c;
  c.scene_hash = 0x0123456789abcdefULL;
  c.scene_name = "liver";
  c.real_type = "float";
  c.step = -5'000'000'000;
  c.time = 0.1;
  c.dt = std::numeric_limits<double>::denorm_min();
  c.host_state["empty"] = {};
  c.host_state["relaxation"] = {1.5, -0.0, std::numeric_limits<double>::infinity(),
                                std::bit_cast<double>(0x7ff8000000000123ULL)};
  c.buffers = {{"u", {1, 2, 3, 255, 0, 7, 8, 9, 10}}, {"", {}}, {"w", std::vector<std::uint8_t>(50, 17)}};
  return c;
}

std::filesystem::path store(const TempFolder& folder, const std::string& bytes) { return folder.write("c", bytes); }

std::string error_of(const std::filesystem::path& file) {
  return test::error_of([&] { read_checkpoint(file); });
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Give altered content the hash that belongs to it, as a hostile writer would.
std::string sealed(std::string bytes) {
  const std::uint64_t hash = hash_bytes(bytes.data(), bytes.size() - 8);
  for (std::size_t i = 0; i < 8; ++i) bytes[bytes.size() - 8 + i] = static_cast<char>(hash >> (8 * i) & 0xff);
  return bytes;
}

TEST(Checkpoint, KeepsEveryBit) {
  const TempFolder folder;
  const Checkpoint c = sample();
  write_checkpoint(folder.path() / "c", c);
  const Checkpoint r = read_checkpoint(folder.path() / "c");
  EXPECT_EQ(r.scene_hash, c.scene_hash);
  EXPECT_EQ(r.scene_name, c.scene_name);
  EXPECT_EQ(r.real_type, c.real_type);
  EXPECT_EQ(r.step, c.step);
  EXPECT_EQ(r.time, c.time);
  EXPECT_EQ(r.dt, c.dt);
  EXPECT_EQ(r.buffers, c.buffers);
  ASSERT_EQ(r.host_state.size(), 2u);
  const auto& values = r.host_state.at("relaxation");
  ASSERT_EQ(values.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(values[i]), std::bit_cast<std::uint64_t>(c.host_state.at("relaxation")[i]));
  }
  write_checkpoint(folder.path() / "d", r);
  EXPECT_EQ(bytes_of(folder.path() / "c"), bytes_of(folder.path() / "d"));
}

TEST(Checkpoint, EveryTruncationIsAnError) {
  const TempFolder folder;
  write_checkpoint(folder.path() / "c", sample());
  const std::string bytes = bytes_of(folder.path() / "c");
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_THROW(read_checkpoint(store(folder, bytes.substr(0, n))), Error) << n;
  const std::string message = error_of(store(folder, bytes.substr(0, 100)));
  EXPECT_TRUE(contains(message, "truncated") && contains(message, "found 100") &&
              contains(message, std::to_string(bytes.size())))
      << message;
  EXPECT_TRUE(contains(error_of(store(folder, bytes + "x")), "damaged"));
}

TEST(Checkpoint, EveryFlippedBitIsAnError) {
  const TempFolder folder;
  write_checkpoint(folder.path() / "c", sample());
  const std::string bytes = bytes_of(folder.path() / "c");
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bad = bytes;
      bad[i] = static_cast<char>(bad[i] ^ (1 << bit));
      EXPECT_THROW(read_checkpoint(store(folder, bad)), Error) << i;
    }
  }
}

TEST(Checkpoint, AlteredContentWithARightHashNeverCrashes) {
  const TempFolder folder;
  write_checkpoint(folder.path() / "c", sample());
  const std::string bytes = bytes_of(folder.path() / "c");
  int errors = 0;
  for (std::size_t i = 24; i + 8 < bytes.size(); ++i) {
    for (const int value : {0, 1, 127, 255}) {
      std::string bad = bytes;
      bad[i] = static_cast<char>(value);
      try {
        read_checkpoint(store(folder, sealed(bad)));
      } catch (const Error&) {
        ++errors;
      }
    }
  }
  EXPECT_GT(errors, 100);
  std::string bad = bytes;
  bad.replace(32, 8, std::string(7, '\xff') + "\x7f");  // the length of the scene's name
  const std::string message = error_of(store(folder, sealed(bad)));
  EXPECT_TRUE(contains(message, "9223372036854775807") && contains(message, "scene name")) << message;
}

TEST(Checkpoint, SaysWhatTheFileIs) {
  const TempFolder folder;
  EXPECT_TRUE(contains(error_of(folder.path() / "none"), "no such file"));
  EXPECT_TRUE(contains(error_of(folder.path()), "no such file"));
  EXPECT_TRUE(contains(error_of(store(folder, "")), "not a Pliant checkpoint"));
  EXPECT_TRUE(contains(error_of(store(folder, std::string(200, 'a'))), "not a Pliant checkpoint"));
  write_checkpoint(folder.path() / "c", sample());
  std::string bytes = bytes_of(folder.path() / "c");
  bytes[8] = 9;
  EXPECT_TRUE(contains(error_of(store(folder, sealed(bytes))), "version 9"));
  Checkpoint c = sample();
  c.real_type = "half";
  EXPECT_THROW(write_checkpoint(folder.path() / "c", c), Error);
}

TEST(Hash, DependsOnEveryByteItsPlaceTheLengthAndTheSeed) {
  std::string text(67, '\0');
  std::vector<std::uint64_t> seen{hash_bytes(text), hash_bytes(text, 1), hash_bytes(text.data(), 66),
                                  hash_bytes(text.data(), 64), hash_bytes("", 0)};
  for (char& c : text) {
    for (int bit = 0; bit < 8; ++bit) {
      c = static_cast<char>(1 << bit);
      seen.push_back(hash_bytes(text));
    }
    c = 0;
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::unique(seen.begin(), seen.end()), seen.end());
}

TEST(Hash, AFlippedInputBitFlipsHalfOfTheHash) {
  std::string text = "the quick brown fox jumps over the lazy dog";
  const std::uint64_t base = hash_bytes(text);
  double flipped = 0;
  for (char& c : text) {
    for (int bit = 0; bit < 8; ++bit) {
      c = static_cast<char>(c ^ (1 << bit));
      flipped += std::popcount(hash_bytes(text) ^ base);
      c = static_cast<char>(c ^ (1 << bit));
    }
  }
  EXPECT_NEAR(flipped / (8.0 * static_cast<double>(text.size())), 32, 1);
}

TEST(Hash, ValuesAreFixed) {
  // From a second implementation, in Python integers. Golden runs and checkpoints depend on them.
  EXPECT_EQ(hash_text(hash_bytes(std::string())), "bd0333a56e872f86");
  EXPECT_EQ(hash_text(hash_bytes(std::string("pliant"))), "cdaa8f67693f2b42");
  EXPECT_EQ(hash_text(hash_bytes(std::string("a soft body deforms"), 7)), "6f97412862252c00");
  EXPECT_EQ(hash_text(0xabcULL), "0000000000000abc");
}

}  // namespace
}  // namespace pliant
