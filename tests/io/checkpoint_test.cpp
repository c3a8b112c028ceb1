#include "io/checkpoint.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  c.scene_name = "liver";
  Snapshot& s = c.snapshot;
  s.made_of = {{"gravity", 0x0123456789abcdefULL}, {"", 0}};
  s.real_type = "float";
  s.state.clock = {-5'000'000'000, 7, 0.1, std::numeric_limits<double>::denorm_min()};
  s.state.relaxation.u = {1.5, -0.0, std::numeric_limits<double>::infinity(), std::bit_cast<double>(0x7ff8000000000123ULL)};
  s.state.kept = KeptState{{1, 2, 3, 4}, 5, {}};
  s.state.cuts = {{1, {{{2, 3}, 0.25}, {{2, 4}, 0.5}}}};
  s.state.tears = {{0, 17, 5}};
  s.state.regions = {{{1, 2, 3}, {4, 7}}};
  s.state.blades.seen = 0.25;
  s.state.blades.met = {"knife", "host/saw"};
  s.state.blades.placed["scalpel"] = {Vec3d{1, 2, 3}, Vec3d{4, 5, 6}};
  s.state.blades.traces["scalpel"][1] = {{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}, 3, {{1, -1, {4, 2, {0.25, 0.25, 0.25, 0.25}, {}}}}};
  s.state.pending.triangles = {{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}};
  s.state.pending.moves = {{"host/scalpel", {}, {{Vec3d{1, 1, 1}, Vec3d{2, 2, 2}}}}};
  s.state.forces = {{0, 12, {1, 0, 0}}};
  s.state.focus = Vec3d{0, 0, 1};
  s.state.pressed["scalpel"] = {Vec3d{0, -1, 0}, {FrontSample{2, 1, {}, 0.5}}, 0.25, 0.125, 3, 0.5, 7, 8};
  s.state.kept->pressed = s.state.pressed;
  s.state.driven_blades["scalpel"] = {{{Vec3d{1, 2, 3}, Vec3d{4, 5, 6}}, {Vec3d{7, 8, 9}, Vec3d{1, 1, 1}}, 0.5, 1, false},
                                      {{Vec3d{7, 8, 9}, Vec3d{1, 1, 1}}, {Vec3d{7, 8, 9}, Vec3d{1, 1, 1}}, 1, 1, true}};
  s.state.driven["rod"] = {{{{1, 2, 3}, {0, 0, 0, 1}}, {{4, 5, 6}, {0, 0, 0, 1}}, 0.25, 0.75}};
  s.state.topology_version = 3;
  s.reports.now.inversions = {1, 2, 3, 4, 0.5, 6, "liver", 7};
  s.reports.now.tools = {{{{{1, 2, 3}, {4, 5, 6}}, 0.25, 0.5, 7},
                          1,
                          2,
                          3,
                          4,
                          {{0, 1, 0}},
                          5,
                          {1, 2, 3, {4, 5, 6}, 7},
                          {8, 9, 10, {11, 12, 13}, 14}}};
  s.reports.now.energy = {1.0, 2, 3};
  s.buffers = {{"u", {1, 2, 3, 255, 0, 7, 8, 9, 10}}, {"", {}}, {"w", std::vector<std::uint8_t>(50, 17)}};
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
  EXPECT_EQ(r.scene_name, c.scene_name);
  EXPECT_EQ(r.snapshot.made_of, c.snapshot.made_of);
  EXPECT_EQ(r.snapshot.real_type, c.snapshot.real_type);
  EXPECT_EQ(r.snapshot.buffers, c.snapshot.buffers);
  EXPECT_EQ(write_state(r.snapshot.state), write_state(c.snapshot.state));
  EXPECT_EQ(write_report(r.snapshot.reports), write_report(c.snapshot.reports));
  EXPECT_EQ(r.snapshot.state.clock.step, c.snapshot.state.clock.step);
  ASSERT_EQ(r.snapshot.state.relaxation.u.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(r.snapshot.state.relaxation.u[i]),
              std::bit_cast<std::uint64_t>(c.snapshot.state.relaxation.u[i]));
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
  bad.replace(32, 8, std::string(7, '\xff') + "\x7f");  // the length of the first part's name
  const std::string message = error_of(store(folder, sealed(bad)));
  EXPECT_TRUE(contains(message, "9223372036854775807") && contains(message, "part's name")) << message;
}

TEST(Checkpoint, SaysWhatTheFileIs) {
  const TempFolder folder;
  EXPECT_TRUE(contains(error_of(folder.path() / "none"), "no such file"));
  EXPECT_TRUE(contains(error_of(folder.path()), "no such file"));
  EXPECT_TRUE(contains(error_of(store(folder, "")), "not a Pliant checkpoint"));
  EXPECT_TRUE(contains(error_of(store(folder, std::string(200, 'a'))), "not a Pliant checkpoint"));
  write_checkpoint(folder.path() / "c", sample());
  std::string bytes = bytes_of(folder.path() / "c");
  bytes[8] = 99;
  EXPECT_TRUE(contains(error_of(store(folder, sealed(bytes))), "version 99"));
  Checkpoint c = sample();
  c.snapshot.real_type = "half";
  EXPECT_THROW(write_checkpoint(folder.path() / "c", c), Error);
}

TEST(Hash, IsXxh3) {
  // What `printf '%s' TEXT | xxhsum -H3` prints, of short texts and a long one.
  std::string counted;
  for (int i = 0; i < 300; ++i) counted += std::to_string(i);  // `seq -s '' 0 299`, without its newline
  EXPECT_EQ(hash_text(hash_bytes(std::string())), "2d06800538d394c2");
  EXPECT_EQ(hash_text(hash_bytes(std::string("pliant"))), "65c581e31c46f86f");
  EXPECT_EQ(hash_text(hash_bytes(std::string("a soft body deforms"))), "9c6ddc961dde7f32");
  EXPECT_EQ(hash_text(hash_bytes(counted)), "a2b74557888b7b42");
  EXPECT_EQ(hash_text(0xabcULL), "0000000000000abc");
}

TEST(Hash, OfPiecesIsThatOfTheWhole) {
  std::string text;
  for (int i = 0; i < 2000; ++i) text.push_back(static_cast<char>(37 * i));
  for (const std::size_t piece : {1, 7, 64, 300, 1999}) {
    Hasher pieces;
    for (std::size_t i = 0; i < text.size(); i += piece) {
      EXPECT_EQ(pieces.value(), hash_bytes(text.data(), i)) << "asked on the way";
      pieces.add(text.data() + i, std::min(piece, text.size() - i));
    }
    EXPECT_EQ(pieces.value(), hash_bytes(text)) << piece;
  }
}

}  // namespace
}  // namespace pliant
