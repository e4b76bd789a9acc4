#include "experiments/formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/numbers.hpp"

namespace plica {
namespace {

using Value = std::optional<double>;
using RowIndex = std::optional<std::size_t>;
using Part = Formula::Part;

Value finite(double value) { return std::isfinite(value) ? Value(value) : std::nullopt; }

// Part from a function of the values of other parts; missing if one of them is.
template <class Function>
Part of(std::vector<Part> parts, Function function) {
  return [parts = std::move(parts), function](const RunNumbers& run, RowIndex row) -> Value {
    std::vector<double> values;
    for (const Part& part : parts) {
      const Value value = part(run, row);
      if (!value) return std::nullopt;
      values.push_back(*value);
    }
    return finite(function(values));
  };
}

Part number_named(const std::string& name) {
  return [name](const RunNumbers& run, RowIndex row) -> Value {
    if (row)
      if (const auto column = run.series.column(name)) return run.series.rows[*row][*column];
    return number_of(run.summary, name);
  };
}

Part value_at(const std::string& name, Part time) {
  return [name, time = std::move(time)](const RunNumbers& run, RowIndex) -> Value {
    const auto column = run.series.column(name);
    const Value time_s = time(run, {});
    if (!column || !time_s || run.series.rows.empty()) return std::nullopt;
    return run.series.at(*column, std::min(*time_s, *run.series.rows.back().front()));
  };
}

// First time at which all of the differences begin to be positive, linear between rows.
Part first_time(std::vector<Part> differences) {
  return [differences = std::move(differences)](const RunNumbers& run, RowIndex) -> Value {
    bool held = true;  // the reference state is no beginning
    for (std::size_t k = 1; k < run.series.rows.size(); ++k) {
      double from = 0, to = 1;  // part of the interval between the rows
      for (const Part& difference : differences) {
        const Value a = difference(run, k - 1), b = difference(run, k);
        if (!a || !b || (*a < 0 && *b < 0))
          from = 2;
        else if (*a < 0)
          from = std::max(from, *a / (*a - *b));
        else if (*b < 0)
          to = std::min(to, *a / (*a - *b));
      }
      const double start_s = *run.series.rows[k - 1].front(), end_s = *run.series.rows[k].front();
      if (from <= to && !(held && from == 0)) return start_s + from * (end_s - start_s);
      held = from <= to && to == 1;
    }
    return std::nullopt;
  };
}

// Largest or least value at the rows at which no difference is negative.
Part extreme(std::vector<Part> parts, bool is_largest) {
  return [parts = std::move(parts), is_largest](const RunNumbers& run, RowIndex) -> Value {
    Value found;
    for (std::size_t k = 0; k < run.series.rows.size(); ++k) {
      const Value value = parts.front()(run, k);
      const bool holds = std::all_of(parts.begin() + 1, parts.end(),
                                     [&](const Part& difference) { return difference(run, k).value_or(-1) >= 0; });
      if (value && holds && (!found || (is_largest ? *value > *found : *value < *found))) found = value;
    }
    return found;
  };
}

double rank_correlation(const std::vector<double>& values) {
  const std::size_t count = values.size();
  std::vector<double> order(count), ranks(count);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = 0; i < count; ++i)
    for (const double other : values) ranks[i] += other < values[i] ? 1 : other == values[i] ? 0.5 : 0;
  const auto product = [&](const std::vector<double>& a, const std::vector<double>& b) {
    const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / static_cast<double>(count);
    const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / static_cast<double>(count);
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0, std::plus<>(),
                              [&](double x, double y) { return (x - mean_a) * (y - mean_b); });
  };
  return product(order, ranks) / std::sqrt(product(order, order) * product(ranks, ranks));
}

}  // namespace

class FormulaParser {
 public:
  FormulaParser(const std::string& text, const std::map<std::string, Formula>& named, Formula& result)
      : text_(text), named_(named), result_(result) {}

  void parse() {
    result_.part_ = sum();
    if (at_ != text_.size()) refuse();
  }

 private:
  [[noreturn]] void refuse() const {
    throw std::invalid_argument(at_ < text_.size()
                                    ? fmt::format("has \"{}\" where that is not understood", text_.substr(at_))
                                    : "is incomplete");
  }

  bool take(char sign) {
    skip_spaces();
    if (at_ == text_.size() || text_[at_] != sign) return false;
    ++at_;
    skip_spaces();
    return true;
  }

  void skip_spaces() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  std::string word() {
    skip_spaces();
    const std::size_t start = at_;
    const auto is_of_word = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-';
    };
    while (at_ < text_.size() && is_of_word(text_[at_])) ++at_;
    if (at_ == start) refuse();
    return text_.substr(start, at_ - start);
  }

  Part sum() {
    Part left = product();
    while (true) {
      const bool adds = take('+');
      if (!adds && !take('-')) return left;
      left = of({left, product()}, [adds](const auto& v) { return adds ? v[0] + v[1] : v[0] - v[1]; });
    }
  }

  Part product() {
    Part left = factor();
    while (true) {
      const bool multiplies = take('*');
      if (!multiplies && !take('/')) return left;
      left = of({left, factor()}, [multiplies](const auto& v) { return multiplies ? v[0] * v[1] : v[0] / v[1]; });
    }
  }

  Part factor() {
    if (take('(')) {
      if (++depth_ > deepest) throw std::invalid_argument("is nested too deeply");
      Part inner = sum();
      if (!take(')')) refuse();
      --depth_;
      return inner;
    }
    const std::string name = word();
    if (const Value number = number_in(name)) return [number](const RunNumbers&, RowIndex) { return number; };
    if (take('(')) return function(name);
    if (take('@')) {
      Part time = factor();
      result_.uses_.emplace_back(name, Formula::Source::series);
      return value_at(name, std::move(time));
    }
    if (const auto found = named_.find(name); found != named_.end()) {
      const auto& uses = found->second.uses_;
      result_.uses_.insert(result_.uses_.end(), uses.begin(), uses.end());
      return found->second.part_;
    }
    result_.uses_.emplace_back(name, is_of_rows_ ? Formula::Source::either : Formula::Source::summary);
    return number_named(name);
  }

  Part function(const std::string& name) {
    std::vector<Part> parts;
    const bool is_extreme = name == "largest" || name == "least", is_first = name == "first";
    const bool was_of_rows = std::exchange(is_of_rows_, is_of_rows_ || is_extreme || is_first);
    if (++depth_ > deepest) throw std::invalid_argument("is nested too deeply");
    do {
      parts.push_back(is_first || (is_extreme && !parts.empty()) ? condition() : sum());
    } while (take(','));
    if (!take(')')) refuse();
    is_of_rows_ = was_of_rows, --depth_;
    if (is_first) return first_time(std::move(parts));
    if (is_extreme) return extreme(std::move(parts), name == "largest");
    if (name == "max") return of(std::move(parts), [](const auto& v) { return *std::ranges::max_element(v); });
    if (name == "min") return of(std::move(parts), [](const auto& v) { return *std::ranges::min_element(v); });
    if (name == "rank_correlation") return of(std::move(parts), rank_correlation);
    throw std::invalid_argument(
        fmt::format("\"{}\" is not a function; use max, min, first, largest, least or rank_correlation", name));
  }

  // Difference of both sides, positive if the condition holds.
  Part condition() {
    Part left = sum();
    const bool is_above = take('>');
    if (!is_above && !take('<')) refuse();
    return of({std::move(left), sum()}, [is_above](const auto& v) { return is_above ? v[0] - v[1] : v[1] - v[0]; });
  }

  static constexpr int deepest = 50;
  const std::string& text_;
  const std::map<std::string, Formula>& named_;
  Formula& result_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool is_of_rows_ = false;
};

Formula::Formula(const std::string& text, const std::map<std::string, Formula>& named) {
  FormulaParser(text, named, *this).parse();
}

bool Formula::uses_series() const {
  return std::ranges::any_of(uses_, [](const auto& use) { return use.second != Source::summary; });
}

}  // namespace plica
