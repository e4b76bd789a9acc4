// Reaction of a signal: one line of text, compiled once and evaluated cell by cell.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace plica {

/// Error: a text is not a valid reaction. `unknown`: the name that it does not know, if that is the reason.
struct ReactionError : std::runtime_error {
  ReactionError(const std::string& problem, std::string unknown_name = {})
      : std::runtime_error(problem), unknown(std::move(unknown_name)) {}
  std::string unknown;
};

class Reaction {
 public:
  /// Compile a text of variables (unique), constants and functions. Throws ReactionError.
  Reaction(const std::string& text, const std::vector<std::string>& variables,
           const std::map<std::string, double>& constants);
  Reaction(Reaction&&) noexcept;
  Reaction& operator=(Reaction&&) noexcept;
  ~Reaction();

  /// Whether the text contains this variable.
  [[nodiscard]] bool reads(const std::string& variable) const;

  /// Return its value at values of the variables, in their order; infinite or NaN where it has none.
  [[nodiscard]] double at(std::span<const double> values);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// Whether a name can occur in a reaction: letters, digits and "_", no digit first.
bool is_reaction_name(const std::string& name);

/// Names of functions and constants that every reaction has.
std::vector<std::string> reaction_functions();

}  // namespace plica
