// Recorded strokes: the poses of a device over time, as a CSV file. The same bits come back from a file that was written here.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/haptic_device.h"

namespace pliant::devices {

/// First line of a stroke: time [s], position [m], orientation as unit quaternion x, y, z, w, a bit per button.
inline constexpr std::string_view kStrokeHead = "time,x,y,z,qx,qy,qz,qw,buttons";

/// Reads the text of a file. Lines that are empty or begin with # are skipped. Samples are numbered from 1. Throws Error
/// `bad_input` "<file>:<line>: ..." for another first line, a line of other than nine numbers, what check_sample refuses, times
/// that do not increase, and a stroke without a sample. A quaternion within 1e-12 of unit length keeps its bits.
std::vector<DeviceSample> parse_stroke(std::string_view text, const std::string& file);

/// The text of a file, 17 digits per number.
std::string stroke_text(std::span<const DeviceSample> samples);

/// Throw Error `io` if the file cannot be read, is larger than 1 GiB, or cannot be written. A file that is written appears
/// under its name when it is complete.
std::vector<DeviceSample> read_stroke(const std::filesystem::path& file);
void write_stroke(const std::filesystem::path& file, std::span<const DeviceSample> samples);

}  // namespace pliant::devices
