#include "mechanics/signals/reaction.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace plica {

struct Reaction::Parser {
  mu::Parser text;
  std::vector<double> values;  // of the variables
};

Reaction::Reaction(const std::string& text, const std::vector<std::string>& variables,
                   const std::map<std::string, double>& constants) try
    : parser_(std::make_unique<Parser>()) {
  mu::Parser& parser = parser_->text;
  parser_->values.resize(variables.size());
  for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineVar(variables[i], &parser_->values[i]);
  for (const auto& [name, value] : constants) parser.DefineConst(name, value);
  parser.SetExpr(text);
  // The parser would assign to variables, and return the last of several expressions.
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto is_any_of = [](char c, std::string_view all) { return all.find(c) != std::string_view::npos; };
    if (text[i] == '=' && !(i + 1 < text.size() && text[i + 1] == '=') && !(i > 0 && is_any_of(text[i - 1], "=<>!")))
      throw ReactionError("assigns a value with \"=\"");
  }
  int results = 0;
  parser.Eval(results);
  if (results != 1) throw ReactionError(fmt::format("has {} expressions instead of one", results));
} catch (const mu::ParserError& error) {
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && is_reaction_name(error.GetToken()))
    throw ReactionError(fmt::format("\"{}\" is unknown", error.GetToken()), error.GetToken());
  std::string reason = error.GetMsg();
  while (!reason.empty() && (reason.back() == '.' || std::isspace(static_cast<unsigned char>(reason.back())) != 0))
    reason.pop_back();
  if (!reason.empty()) reason.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(reason.front())));
  throw ReactionError("cannot be read: " + reason);
}

Reaction::Reaction(Reaction&&) noexcept = default;
Reaction& Reaction::operator=(Reaction&&) noexcept = default;
Reaction::~Reaction() = default;

bool Reaction::reads(const std::string& variable) const { return parser_->text.GetUsedVar().contains(variable); }

double Reaction::at(std::span<const double> values) {
  std::ranges::copy(values, parser_->values.begin());
  return parser_->text.Eval();
}

bool is_reaction_name(const std::string& name) {
  const auto is_letter = [](unsigned char c) { return c < 128 && (std::isalpha(c) != 0 || c == '_'); };
  return !name.empty() && is_letter(name.front()) &&
         std::ranges::all_of(name, [&](unsigned char c) { return is_letter(c) || std::isdigit(c) != 0; });
}

std::vector<std::string> reaction_functions() {
  const mu::Parser parser;
  std::vector<std::string> names;
  for (const auto& [name, function] : parser.GetFunDef()) names.push_back(name);
  for (const auto& [name, value] : parser.GetConst()) names.push_back(name);
  return names;
}

}  // namespace plica
