#include <string>
#include <vector>

#include "scenario/load.hpp"
#include "targets.hpp"

namespace plica {
namespace {

void require(bool holds) {
  if (!holds) __builtin_trap();
}

std::vector<std::string> overrides_in(const std::string& text) {
  std::vector<std::string> overrides;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (text.compare(at, 3, "#! ") == 0) overrides.push_back(text.substr(at + 3, end - at - 3));
    at = end + 1;
  }
  return overrides;
}

}  // namespace

bool fuzz_scenario(std::string_view bytes) try {
  const std::string text(bytes);
  const Scenario scenario = load_scenario({"fuzzed", "/nowhere/fuzzed.toml", text}, overrides_in(text));
  require(scenario.time.end_s > 0);
  return true;
} catch (const ScenarioError& error) {
  require(!error.diagnostics().empty());
  for (const Diagnostic& diagnostic : error.diagnostics())
    require(!diagnostic.problem.empty() && !diagnostic.remedy.empty() &&
            diagnostic.text().find('\n') == std::string::npos);
  return false;
}

}  // namespace plica
