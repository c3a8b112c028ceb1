// Features of soft-tissue engines that this version lacks, each with the nearest one that it has: one table for the readers.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace pliant {

/// Where a word stands: a value of a key (`law`, `element`, `integrator`, `model/type`, `solver/type`, `curve`), a key of an
/// object
/// (`key of material`, `key of body`, `key of scene`, `key of shape`), or the extension of a file (`surface`, `mesh`).
struct Lacking {
  std::string_view where;
  std::string_view words;    ///< separated by spaces, each in small letters and without hyphens and underscores
  std::string_view missing;  ///< "no law with a memory"
  std::string_view nearest;  ///< the alternative in this version
};
std::span<const Lacking> lacking_table();

/// A half-sentence such as "; this version has no law with a memory: the nearest is ..."; empty for features that the table
/// does not have.
std::string lacking(std::string_view where, std::string_view word);

}  // namespace pliant
