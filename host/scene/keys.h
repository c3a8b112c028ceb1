// The allowed keys of each object of a scene file, and the words for enumerators. The loader, its messages, the writer and
// the check of scenes/schema.json use these tables.
#pragma once
#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pliant/error.h"
#include "scene/probe.h"
#include "scene/scene.h"

namespace pliant {

/// The allowed keys by kind of object: "scene" (the file itself), "body", "material", ... The same words name the definitions
/// in scenes/schema.json.
const std::map<std::string, std::vector<std::string>>& scene_keys();

/// Parameters that can define a law: the moduli (young, poisson, lambda, mu, kappa), or its own parameters; those of all laws,
/// each once.
std::vector<std::string> moduli_keys();
std::vector<std::string> elastic_keys(const LawInfo& law);
std::vector<std::string> elastic_keys();
/// Keys of hybrid models only, those that determine how the operational region grows, and those shared with pure shape
/// matching.
std::vector<std::string> hybrid_keys();
std::vector<std::string> growth_keys();
std::vector<std::string> matching_keys();

/// The laws with a property, as "a, b or c".
std::string laws_with(bool LawInfo::*property);
std::string elements_with(const std::function<bool(const ElementInfo&)>& has);

/// A word of a scene file or an option, its enumerator, and a description for users.
template <class Enum>
struct Word {
  std::string word;
  Enum value;
  std::string what;
};
template <class Enum>
using Words = std::vector<Word<Enum>>;

const Words<Law>& law_words();
const Words<ElementKind>& element_words();
const Words<Curve::Kind>& curve_words();
const Words<Integrator>& integrator_words();
const Words<Inverted>& inverted_words();
const Words<BladeCuts>& blade_cuts_words();
const Words<BladeMethod>& blade_method_words();
/// The shapes of tools, which are keys.
const Words<ToolShape>& tool_shape_words();
const Words<bool>& solver_words();
const Words<ModelType>& model_words();
const Words<SpringLaw>& spring_law_words();
/// The flags of DeformationModel that a scene file writes as words: extrapolate, conservative.
const Words<bool>& goals_words();
const Words<bool>& coupling_words();
const Words<Quantity>& quantity_words();

template <class Enum>
std::vector<std::string> words_only(const Words<Enum>& words) {
  std::vector<std::string> list;
  for (const Word<Enum>& w : words) list.push_back(w.word);
  return list;
}

/// Lists of the enumerators, for loops over all elements, integrators, ...
template <class Enum>
std::vector<Enum> values_of(const Words<Enum>& words) {
  std::vector<Enum> list;
  for (const Word<Enum>& w : words) list.push_back(w.value);
  return list;
}

/// "WORD (what it means), ...", for the help of an option.
template <class Enum>
std::string explained(const Words<Enum>& words) {
  std::string text;
  for (const Word<Enum>& w : words) text += (text.empty() ? "" : ", ") + w.word + " (" + w.what + ")";
  return text;
}

/// The word of an enumerator.
template <class Enum>
const std::string& word_of(const Words<Enum>& words, Enum value) {
  for (const Word<Enum>& w : words) {
    if (w.value == value) return w.word;
  }
  throw Error(ErrorCode::internal, "an enumerator has no word in host/scene/keys.cpp");
}

/// The word nearest to `text` by edit distance, or "" when none is near enough to be a likely slip.
std::string nearest(const std::string& text, const std::vector<std::string>& words);

/// "a, b, c"
std::string listed(const std::vector<std::string>& words);
/// "a, b or c"
std::string alternatives(const std::vector<std::string>& words);

}  // namespace pliant
