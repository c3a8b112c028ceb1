// The part of RunState that holds changed parameters of the scene (edits/parameter_edits.h).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace pliant {

/// Parameters that differ from those of the scene (scene/change.h).
struct ChangedParameters {
  std::int64_t done = 0;             ///< number of entries of the scene's "changes" that have been made
  std::int64_t step = -1;            ///< step of the last change, where a batch begins; -1: none
  std::string parameters;            ///< JSON text; empty: those of the scene
  std::vector<std::string> waiting;  ///< changes of the host until subcycles begin, in their order
  [[nodiscard]] bool empty() const { return done == 0 && parameters.empty() && waiting.empty(); }
};

template <class V>
void visit(V& v, ChangedParameters& s) {
  v("done", s.done), v("step", s.step), v("parameters", s.parameters), v("waiting", s.waiting);
}

}  // namespace pliant
