// Motions that the host has requested for a tool or blade, as far back as a rollback may go: whatever time the clock is set
// back to, the part is where it was then, and goes the same way again.
#pragma once
#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace pliant {

/// Drive has the members `start` and `end` [s]; it is in effect from its start to that of the next one.
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

}  // namespace pliant
