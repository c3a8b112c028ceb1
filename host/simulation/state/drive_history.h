// Motions that the host has requested for a tool or blade, as far back as a rollback may go: whatever time the clock is set
// back to, the part is where it was then, and goes the same way again. Where the host has placed it elsewhere in between it is
// there from the beginning: between two places there is no way.
#pragma once
#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace pliant {

/// Drive has the members `start` and `end` [s], `from`, where it begins, and at(time); it is in effect from its start to that
/// of the next one, and of no length where the part is placed.
template <class Drive>
using DriveHistory = std::map<std::string, std::vector<Drive>>;  ///< by name, each ascending in time

/// Returns the drive of a part that is in effect at a time [s]; nullptr: the part is on its path.
template <class Drive>
const Drive* drive_at(const DriveHistory<Drive>& all, const std::string& name, double time) {
  const auto own = all.find(name);
  if (own == all.end()) return nullptr;
  const auto begun = std::find_if(own->second.rbegin(), own->second.rend(), [&](const Drive& d) { return d.start <= time; });
  return begun == own->second.rend() ? nullptr : &*begun;
}

/// What was requested for a later time, before a rollback, does not happen any more.
template <class Drive>
void add_drive(DriveHistory<Drive>& all, const std::string& name, const Drive& next) {
  std::vector<Drive>& own = all[name];
  std::erase_if(own, [&](const Drive& d) { return d.start >= next.start; });
  own.push_back(next);
}

/// Forgets the drives that were in effect only before `time` [s].
template <class Drive>
void forget_drives(DriveHistory<Drive>& all, double time) {
  for (auto& [name, own] : all) {
    const Drive* first = drive_at(all, name, time);
    if (first != nullptr) own.erase(own.begin(), own.begin() + (first - own.data()));
  }
}

/// Whether a part does not go on from where it was when a drive began. path(time): its place before the first one.
template <class Drive, class Path>
bool jumps(const std::vector<Drive>& own, std::size_t i, const Path& path) {
  const Drive& d = own[i];
  return d.end == d.start || d.from != (i > 0 ? own[i - 1].at(d.start) : path(d.start));
}

/// Call for a part whose clock is set back to `now` [s]: of what follows the last jump alone happens again. Returns whether
/// there was one.
template <class Drive, class Path>
bool stay_after_jumps(std::vector<Drive>& own, double now, const Path& path) {
  for (std::size_t i = own.size(); i-- > 0 && own[i].start > now;) {
    if (!jumps(own, i, path)) continue;
    Drive there = own[i];
    there.to = there.from;
    there.start = there.end = now;
    own.erase(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(i));
    own.insert(own.begin(), there);
    return true;
  }
  return false;
}

/// The step before a time [s] began at `before`: returns the time from which on a part has gone its way without a jump.
template <class Drive, class Path>
double since_jump(const DriveHistory<Drive>& all, const std::string& name, double before, double now, const Path& path) {
  const Drive* d = drive_at(all, name, now);
  if (d == nullptr || d->start <= before) return before;
  const std::vector<Drive>& own = all.at(name);
  return jumps(own, static_cast<std::size_t>(d - own.data()), path) ? d->start : before;
}

}  // namespace pliant
