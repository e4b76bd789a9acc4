#include "show/picture_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"

namespace plica {
namespace {

constexpr Rgb ink = {0.12, 0.12, 0.12};

// Widths and heights in units of the letter height ("em"), so that the layout scales with the picture.
constexpr double font_of_width = 0.0165, smallest_font_px = 9;
constexpr double letter_em = 0.56;  // mean width of a letter
constexpr double line_em = 1.25, bar_em = 1.0, mark_em = 1.35, gap_em = 0.5;
constexpr double heading_em = 2.2, footer_em = 2.2;
constexpr double step_em = 1.4;  // of a legend box
constexpr std::size_t legend_title_letters = 13;

// Number of letters, not bytes.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

double width_em(const std::string& text) { return letter_em * static_cast<double>(letters(text)); }

double widest_em(const std::vector<std::string>& texts) {
  double widest = 0;
  for (const std::string& text : texts) widest = std::max(widest, width_em(text));
  return widest;
}

std::string number_text(double value) {
  const bool large = std::abs(value) >= 1e4 && std::abs(value) < 1e7;  // 15000, not 1.5e+04
  std::string text = large ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value + 0.0);
  return text.starts_with('-') ? "\u2212" + text.substr(1) : text;
}

// Name of a view as a heading: "cross-section" is kept, "sagittal-section" may be broken.
std::vector<std::string> heading_lines(const std::string& name, bool broken) {
  const std::size_t hyphen = name.find('-');
  if (!broken || hyphen == std::string::npos) return {name};
  return {name.substr(0, hyphen + 1), name.substr(hyphen + 1)};
}

// Letters of axis ends that a view shows at its border, with their directions on the screen.
struct Mark {
  std::string text;
  std::array<double, 2> direction;  // unit
};
std::vector<Mark> marks_of(const View& view, const EmbryoAxes& letters) {
  constexpr double most_along_sight = 0.6;  // cosine
  const auto [right, up] = screenwise(view);
  const Vec3 sight = view.sight.normalized();
  std::vector<Mark> marks;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(sight[axis]) > most_along_sight) continue;
    const double length = std::hypot(right[axis], up[axis]);
    for (const int side : {0, 1}) {
      if (letters[axis][side].empty()) continue;
      const double sign = (side == 0 ? -1 : 1) / length;
      marks.push_back({letters[axis][side], {sign * right[axis], sign * up[axis]}});
    }
  }
  return marks;
}

// Builder of a layout: sizes first, then from top to bottom.
class Composer {
 public:
  explicit Composer(const Picture& picture) : picture_(picture) {
    const auto columns = static_cast<double>(picture.columns.size());
    layout_.width_px = picture.width_px > 0 ? picture.width_px : columns > 2 ? 1500 : columns > 1 ? 1200 : 1000;
    em_ = layout_.font_px = std::max(smallest_font_px, font_of_width * layout_.width_px);
    const double extra = picture.shell ? 10 : 0;  // um, for the shell around the embryo
    for (const PictureRow& row : picture.rows) {
      half_width_um_ = std::max(half_width_um_, row.half_size_um[0] + extra);
      half_heights_um_.push_back(row.half_size_um[1] + extra);
      for (const Mark& mark : marks_of(row.view, picture.letters)) {
        if (std::abs(mark.direction[0]) > 0.5) side_marks_ = std::round(mark_em * em_);
        if (std::abs(mark.direction[1]) > 0.5) upper_marks_ = std::round(mark_em * em_);
      }
    }
  }

  Layout compose() {
    // "a / b" is broken before the stroke.
    std::string title = picture_.field.title();
    if (const std::size_t stroke = title.find("/ "); stroke != std::string::npos)
      title.replace(stroke + 1, 1, "\u00a0");
    legend_title_ = wrapped(title, legend_title_letters);
    set_sizes();
    const double rows_top = layout_.height_px - top_px() - std::floor((layout_.height_px - needed_height()) / 2);
    double top = rows_top;
    for (std::size_t row = 0; row < picture_.rows.size(); ++row) {
      const double height = row_height(row);
      add_row(row, top, height);
      top -= height;
    }
    add_column_headings(rows_top);
    add_legend(rows_top, top);
    add_footer();
    return layout_;
  }

 private:
  // Panels start and end at whole pixels, with a pixel corner at their centre, to preserve symmetry.
  [[nodiscard]] double top_px() const {
    return std::ceil((heading_em + line_em * static_cast<double>(heading_lines_ - 1)) * em_);
  }

  [[nodiscard]] double legend_em() const {
    double labels = widest_em(picture_.step_names);
    if (picture_.step_names.empty())
      for (const double tick : scale_ticks(picture_.range, 8)) labels = std::max(labels, width_em(number_text(tick)));
    return 2 * gap_em + std::max(widest_em(legend_title_), bar_em + gap_em + labels);
  }

  [[nodiscard]] double row_height(std::size_t row) const {
    return 2 * std::ceil(half_heights_um_[row] / layout_.um_per_px + upper_marks_ + gap_em * em_ / 2);
  }

  [[nodiscard]] double needed_height() const {
    double height = top_px() + std::ceil(footer_em * em_);
    for (std::size_t row = 0; row < picture_.rows.size(); ++row) height += row_height(row);
    return height;
  }

  // Scale of the panels: from the width, or from a given height if that is more restrictive.
  void set_sizes() {
    const auto columns = static_cast<double>(picture_.columns.size());
    for (const bool broken : {false, true}) {
      broken_names_ = broken;
      left_px_ = picture_.rows.size() > 1 ? std::ceil((broken ? 2 * line_em + 0.4 : line_em + 0.4) * em_) : 0;
      panel_px_ = 2 * std::floor((layout_.width_px - left_px_ - legend_em() * em_ - 2 * side_marks_) / columns / 2);
      if (panel_px_ < 3 * em_) throw UsageError("the picture is too narrow for its panels; give a larger --size");
      layout_.um_per_px = 2 * half_width_um_ / (panel_px_ - gap_em * em_);
      wrap_column_headings();
      fit_height();
      if (names_fit()) break;
    }
  }

  void wrap_column_headings() {
    headings_.clear();
    heading_lines_ = 1;
    const auto most = static_cast<std::size_t>(std::max(1.0, panel_px_ / em_ / letter_em));
    for (const PictureColumn& column : picture_.columns) {
      headings_.push_back(wrapped(column.heading, most));
      heading_lines_ = std::max(heading_lines_, headings_.back().size());
    }
  }

  void fit_height() {
    // Even, as video codecs require.
    layout_.height_px = 2 * static_cast<int>(std::ceil(needed_height() / 2));
    if (picture_.height_px <= 0) return;
    layout_.height_px = picture_.height_px;
    double content_um = 0;
    for (const double half : half_heights_um_) content_um += 2 * half;
    const auto rows = static_cast<double>(picture_.rows.size());
    const double other = top_px() + std::ceil(footer_em * em_) + rows * (2 * upper_marks_ + gap_em * em_ + 2);
    const double least = other + 3 * em_ * rows;
    if (layout_.height_px < least)
      throw UsageError(fmt::format("the picture is too low for its rows; give a --size of {}x{} or more",
                                   layout_.width_px, std::ceil(least)));
    layout_.um_per_px = std::max(layout_.um_per_px, content_um / (layout_.height_px - other));
  }

  [[nodiscard]] bool names_fit() const {
    for (std::size_t row = 0; row < picture_.rows.size(); ++row)
      if (width_em(picture_.rows[row].view.heading()) * em_ > row_height(row)) return false;
    return true;
  }

  [[nodiscard]] Box panel_box(std::size_t column, double bottom, double height) const {
    return {left_px_ + (column == 0 ? 0 : 2 * side_marks_) + static_cast<double>(column) * panel_px_, bottom,
            panel_px_ + (column == 0 ? 2 * side_marks_ : 0), height};
  }

  void add_row(std::size_t row, double top, double height) {
    for (std::size_t column = 0; column < picture_.columns.size(); ++column)
      layout_.panels.push_back({panel_box(column, top - height, height), column, row});
    const double middle = top - height / 2;
    if (picture_.rows.size() > 1) {
      const std::vector<std::string> lines = heading_lines(picture_.rows[row].view.heading(), broken_names_);
      for (std::size_t i = 0; i < lines.size(); ++i)
        layout_.labels.push_back(
            {lines[i], (0.3 + line_em * (static_cast<double>(i) + 0.5)) * em_, middle, em_, true, false, true});
    }
    add_marks(row, middle);
  }

  void add_marks(std::size_t row, double middle) {
    const Box box = panel_box(0, 0, 0);
    const View& view = picture_.rows[row].view;
    const auto [right, up] = screenwise(view);
    std::vector<const Vectors*> drawn = {&picture_.columns.front().frame.positions};
    if (picture_.rest) drawn.push_back(&picture_.rest->positions);
    for (const Mark& mark : marks_of(view, picture_.letters)) {
      double reach_um = 0;
      for (const Vectors* positions : drawn)
        for (const Vec3& position : *positions)
          reach_um = std::max(reach_um, mark.direction[0] * position.dot(right) + mark.direction[1] * position.dot(up));
      if (picture_.shell) reach_um += 5;
      const double reach = reach_um / layout_.um_per_px + 0.75 * em_;
      layout_.labels.push_back({mark.text, box.left + box.width / 2 + reach * mark.direction[0],
                                middle + reach * mark.direction[1], em_, true, true});
    }
  }

  void add_column_headings(double rows_top) {
    for (std::size_t column = 0; column < headings_.size(); ++column) {
      const Box box = panel_box(column, 0, 0);
      const std::vector<std::string>& lines = headings_[column];
      for (std::size_t i = 0; i < lines.size(); ++i)
        layout_.labels.push_back({lines[i], box.left + box.width / 2,
                                  rows_top + (0.95 + line_em * static_cast<double>(lines.size() - 1 - i)) * em_,
                                  1.05 * em_, true, true});
    }
  }

  // Colour bar with its title above, centred on the rows.
  void add_legend(double top, double bottom) {
    const double title = line_em * static_cast<double>(legend_title_.size()) + 0.6;
    const bool steps = !picture_.step_names.empty();
    const double most = steps ? step_em * static_cast<double>(picture_.step_names.size()) : 16;
    const double bar = std::min(most, std::max(3.0, 0.94 * (top - bottom) / em_ - title));
    const double left = layout_.width_px - (legend_em() - gap_em) * em_;
    const double bar_bottom = (top + bottom) / 2 - (bar + title) / 2 * em_;
    for (std::size_t i = 0; i < legend_title_.size(); ++i)
      layout_.labels.push_back({legend_title_[i], left,
                                bar_bottom + (bar + title - line_em * (static_cast<double>(i) + 0.5)) * em_, em_,
                                false});
    if (steps)
      add_steps({left, bar_bottom, bar_em * em_, bar * em_});
    else
      add_bar({left, bar_bottom, bar_em * em_, bar * em_});
  }

  void add_frame(const Box& box) {
    layout_.rectangles.push_back({{box.left - 1, box.bottom - 1, box.width + 2, box.height + 2}, ink});
  }

  void add_bar(const Box& box) {
    add_frame(box);
    const ColourRange& range = picture_.range;
    const int pieces = static_cast<int>(std::ceil(box.height));
    for (int i = 0; i < pieces; ++i) {
      const double value = range.low + (range.high - range.low) * (i + 0.5) / pieces;
      layout_.rectangles.push_back({{box.left, box.bottom + box.height * i / pieces, box.width, box.height / pieces},
                                    colour_of(picture_.field.map(), range, value)});
    }
    for (const double tick : scale_ticks(range, static_cast<int>(std::clamp(box.height / em_ / 1.5, 2.0, 8.0)))) {
      const double y = box.bottom + box.height * (tick - range.low) / (range.high - range.low);
      layout_.rectangles.push_back({{box.left + box.width, y - 0.5, 0.25 * em_, 1}, ink});
      layout_.labels.push_back({number_text(tick), box.left + box.width + gap_em * em_, y, em_, false});
    }
  }

  // One box per integer with its name.
  void add_steps(const Box& box) {
    const double height = box.height / static_cast<double>(picture_.step_names.size());
    for (std::size_t value = 0; value < picture_.step_names.size(); ++value) {
      const auto place = static_cast<double>(value);
      const Box step = {box.left, box.bottom + place * height, box.width, 0.85 * height};
      add_frame(step);
      layout_.rectangles.push_back({step, colour_of(picture_.field.map(), picture_.range, place)});
      layout_.labels.push_back(
          {picture_.step_names[value], box.left + box.width + gap_em * em_, step.bottom + step.height / 2, em_, false});
    }
  }

  // Scale bar and meaning of the lines in the panels.
  void add_footer() {
    const double length_um = round_length(0.4 * panel_px_ * layout_.um_per_px), left = left_px_ + em_;
    const double y = footer_em / 2 * em_, thickness = std::max(2.0, 0.14 * em_);
    const double length = length_um / layout_.um_per_px;
    layout_.rectangles.push_back({{left, y - thickness / 2, length, thickness}, ink});
    const std::string text = number_text(length_um) + " \u00b5m";
    double x = left + length + gap_em * em_;
    layout_.labels.push_back({text, x, y, em_, false});
    x += (width_em(text) + 2) * em_;
    const bool cut =
        std::ranges::any_of(picture_.rows, [](const PictureRow& row) { return row.view.cut_axis.has_value(); });
    std::vector<std::string> notes;
    if (picture_.rows.size() == 1) notes.push_back(picture_.rows.front().view.label);
    if (picture_.shell) notes.emplace_back("grey band: vitelline membrane");
    if (cut && picture_.rest && !picture_.shell) notes.emplace_back("grey line: reference state");
    while (!notes.empty()) {
      const std::string words = fmt::format("{}", fmt::join(notes, "; "));
      if (x + width_em(words) * em_ <= layout_.width_px) {
        layout_.labels.push_back({words, x, y, em_, false});
        break;
      }
      notes.erase(notes.begin());
    }
  }

  const Picture& picture_;
  Layout layout_;
  double em_ = 12;
  double half_width_um_ = 0;
  std::vector<double> half_heights_um_;
  double side_marks_ = 0, upper_marks_ = 0;  // px beside and above the embryo, for its labels
  double left_px_ = 0, panel_px_ = 0;
  bool broken_names_ = false;
  std::vector<std::string> legend_title_;
  std::vector<std::vector<std::string>> headings_;
  std::size_t heading_lines_ = 1;
};

}  // namespace

Layout make_layout(const Picture& picture) { return Composer(picture).compose(); }

std::vector<double> scale_ticks(const ColourRange& range, int most) {
  const double span = range.high - range.low;
  if (!(span > 0)) return {range.low};
  constexpr double slack = 1e-9;
  for (double power = std::pow(10, std::floor(std::log10(span)) - 2);; power *= 10)
    for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
      const double step = factor * power;
      const double first = std::ceil(range.low / step - slack), last = std::floor(range.high / step + slack);
      if (last - first + 1 > most && last - first + 1 > 2) continue;
      if (last - first < 1) return {range.low, range.high};
      std::vector<double> ticks;
      for (double i = first; i <= last; ++i) ticks.push_back(i * step);
      return ticks;
    }
}

double round_length(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= value) return factor * power;
  return power;
}

std::vector<std::string> wrapped(const std::string& text, std::size_t most) {
  std::vector<std::string> lines = {""};
  std::size_t from = 0;
  while (from <= text.size()) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, to - from);
    std::string& line = lines.back();
    if (!line.empty() && letters(line) + 1 + letters(word) > most)
      lines.push_back(word);
    else
      line += (line.empty() ? "" : " ") + word;
    from = to + 1;
  }
  return lines;
}

}  // namespace plica
