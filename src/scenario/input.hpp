// What a scenario's sources gave so far, and what is wrong with it. An address is a dotted key whose stand-ins
// (end_min for end_s) are replaced by the key they stand in for, or the path of a table.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scenario/schema.hpp"

namespace plica {

/// Where something was given last. Layers are counted from the deepest base; `--set` is the last.
struct Place {
  std::string file;
  int line = 0;
  int layer = 0;
  std::string written;       // the dotted key as it was written
  const Row* row = nullptr;  // null for a table
};

struct Input {
  std::string file;  // of the scenario itself
  std::map<std::string, Place> places;
  std::set<std::string> doubtful;  // addresses with an error: rules between keys leave them alone
  std::vector<Diagnostic> diagnostics;

  [[nodiscard]] const Place* place(const std::string& address) const {
    const auto found = places.find(address);
    return found == places.end() ? nullptr : &found->second;
  }

  [[nodiscard]] bool sound(const std::string& address) const { return !doubtful.contains(address); }

  /// Whether `address` was given along with `chooser` or after it, so that it cannot have been meant for another choice
  /// that was inherited.
  [[nodiscard]] bool given_with(const std::string& address, const std::string& chooser) const {
    const Place *given = place(address), *choice = place(chooser);
    return given != nullptr && (choice == nullptr || given->layer >= choice->layer);
  }

  /// Reports at the place of `address`, or of the table around it where it was not given.
  void report(const std::string& address, std::string problem, std::string remedy) {
    const Place* here = place(address);
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
