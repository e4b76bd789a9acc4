// Keys read so far, with their places, and errors found. An address is a dotted key in its primary unit (end_s for
// end_min), or the path of a table.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scenario/schema.hpp"

namespace plica {

/// Place where a key was set last. Layers count from the deepest base; `--set` is the last.
struct KeyPlace {
  std::string file;
  int line = 0;
  int layer = 0;
  std::string written;          // the dotted key as it was written
  const KeyRow* row = nullptr;  // null for a table
};

struct Input {
  std::string file;  // the scenario's own
  std::map<std::string, KeyPlace> places;
  std::set<std::string> doubtful;  // addresses with an error, skipped by rules between keys
  std::vector<Diagnostic> diagnostics;

  [[nodiscard]] const KeyPlace* place(const std::string& address) const {
    const auto found = places.find(address);
    return found == places.end() ? nullptr : &found->second;
  }

  [[nodiscard]] bool sound(const auto&... addresses) const { return (!doubtful.contains(addresses) && ...); }

  /// Whether `address` was set in the same layer as `chooser` or later, so it cannot belong to another, inherited
  /// choice.
  [[nodiscard]] bool given_with(const std::string& address, const std::string& chooser) const {
    const KeyPlace *given = place(address), *choice = place(chooser);
    return given != nullptr && (choice == nullptr || given->layer >= choice->layer);
  }

  /// Adds an error at the place of `address`, or of the enclosing table if the key was not set.
  void report(const std::string& address, std::string problem, std::string remedy) {
    const KeyPlace* here = place(address);
    const std::string key = here != nullptr ? here->written : address;
    for (std::string around = address; here == nullptr && around.find('.') != std::string::npos;) {
      around.resize(around.rfind('.'));
      here = place(around);
    }
    diagnostics.push_back({here != nullptr ? here->file : file, here != nullptr ? here->line : 0, key,
                           std::move(problem), std::move(remedy)});
    doubtful.insert(address);
  }
};

}  // namespace plica
