#include "sweep/plot.hpp"

#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "sweep/study/columns.hpp"

namespace spring_pendulum::sweep {
namespace {

using Type = PlotOptions::Type;
using Fields = std::vector<std::string>;

constexpr std::size_t kBins = 40;
/// Size of an entry of the legend, pixels.
constexpr int kKeyLine = 18;
constexpr int kKeyWidth = 250;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Verdicts on a map, from harmless to bad; from blue to brown, also for eyes that do not tell red
/// from green.
struct Shade {
  std::string_view verdict;
  std::string_view color;
  std::string_view label;
};
constexpr Shade kShades[] = {{"", "#c6dbef", "no fault found"},
                             {"inaccurate", "#9e9ac8", "inaccurate"},
                             {"drift", "#fee391", "energy drifts"},
                             {"gained energy", "#f98e1b", "gains energy"},
                             {"diverged", "#662506", "diverges"}};

/// Returns a quoted text. The end of a line would end the command, and the next line would be another one.
std::string gnuplotText(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    const bool is_control = static_cast<unsigned char>(c) < ' ';
    result += c == '\'' ? "''" : std::string(1, is_control ? ' ' : c);
  }
  return result + "'";
}

/// Splits a row of the table.
Fields split(const std::string& row) {
  Fields fields(1);
  bool in_quotes = false;
  for (const char c : row) {
    if (c == '"') {
      in_quotes = !in_quotes;
    } else if (c == ',' && !in_quotes) {
      fields.emplace_back();
    } else if (c != '\n') {
      fields.back() += c;
    }
  }
  return fields;
}

class Plotter {
 public:
  Plotter(const Study& study, const std::vector<std::string>& rows) : study_(study) {
    for (const std::string& row : rows) rows_.push_back(split(row));
    for (std::size_t i = 0; i < study.axes.size(); ++i) {
      place_[study.axes[i].key] = i + 1;
      title_[study.axes[i].key] = study.axes[i].title;
    }
    place_["sample"] = 1 + study.axes.size();
    title_["sample"] = "sample";
    const std::size_t before = 1 + study.axes.size() + (study.samples > 0 ? 1 : 0);
    for (std::size_t i = 0; i < study.columns.size(); ++i) {
      place_[study.columns[i]] = before + i;
      title_[study.columns[i]] = findColumn(study.columns[i], "").title();
    }
  }

  /// The data and, for each panel, a plot command. \returns blocks of data
  std::string data() {
    const std::vector<std::string> panels = valuesOf(p_.panels);
    for (const std::string& panel : panels) {
      commands_.push_back(fmt::format("set title {} noenhanced\n", gnuplotText(panel)) +
                          panelCommand(panel));
    }
    return blocks_;
  }

  /// Everything that is drawn into one picture, after `data`.
  std::string picture() const {
    const Size size = sizeOf();
    const auto share = [](int pixels, int of) { return static_cast<double>(pixels) / of; };
    std::string text = fmt::format(
        "set multiplot layout {},{} margins {:.4f},{:.4f},{:.4f},{:.4f} spacing {:.4f},{:.4f}"
        " title {} noenhanced\n",
        size.rows, size.columns, share(80, size.width), 1.0 - share(20, size.width),
        share(70 + size.key, size.height), 1.0 - share(70, size.height), share(80, size.width),
        share(90, size.height), gnuplotText(p_.title.empty() ? study_.name : p_.title));
    text += fmt::format("set key at screen 0.5,0.01 center bottom vertical maxrows {} noenhanced\n",
                        size.key / kKeyLine);
    for (const std::string& command : commands_) text += command + "unset key\n";
    return text + "unset multiplot\n";
  }

  std::string size() const { return fmt::format("{},{}", sizeOf().width, sizeOf().height); }

  std::string axes() const {
    std::string text = "set tics out nomirror\n";
    const bool is_histogram = p_.type == Type::kHistogram;
    text += fmt::format("set xlabel {} noenhanced\n", gnuplotText(title_.at(p_.x)));
    text += fmt::format("set ylabel {} noenhanced\n",
                        gnuplotText(is_histogram ? "cases" : title_.at(p_.y)));
    if (p_.log_x) text += "set logscale x\nset format x '10^{%T}'\n";
    if (p_.log_y && !is_histogram) text += "set logscale y\nset format y '10^{%T}'\n";
    if (p_.type == Type::kMap && p_.color != "verdict") {
      text += fmt::format("set palette viridis\nset cblabel {} noenhanced\n",
                          gnuplotText(title_.at(p_.color)));
    }
    return text;
  }

 private:
  struct Size {
    int columns, rows;  ///< of panels
    int width, height;  ///< pixels
    int key;            ///< height of the legend, pixels
  };

  Size sizeOf() const {
    const int panels = static_cast<int>(commands_.size());
    const int columns = std::min(panels, 4);
    const int rows = (panels + columns - 1) / columns;
    const int width = panels == 1 ? 800 : 20 + 380 * columns;
    const std::size_t entries = p_.type == Type::kLines ? valuesOf(p_.lines).size() : 6;
    const int key = kKeyLine * std::max(1, static_cast<int>(entries) * kKeyWidth / width + 1);
    return {columns, rows, width, 50 + (panels == 1 ? 470 : 370) * rows + key, key};
  }

  const std::string& fieldOf(const Fields& row, const std::string& key) const {
    return row[place_.at(key)];
  }
  double numberOf(const Fields& row, const std::string& key) const {
    return parseNumber(fieldOf(row, key)).value_or(kNan);
  }

  /// The different values of a key in the order of the table; one empty value without a key.
  std::vector<std::string> valuesOf(const std::string& key) const {
    std::vector<std::string> values;
    if (key.empty()) return {""};
    for (const Fields& row : rows_) {
      if (std::find(values.begin(), values.end(), fieldOf(row, key)) == values.end()) {
        values.push_back(fieldOf(row, key));
      }
    }
    return values;
  }

  /// The rows with a value for a key.
  std::vector<const Fields*> rowsWith(const std::string& panel) const {
    std::vector<const Fields*> rows;
    for (const Fields& row : rows_) {
      if (p_.panels.empty() || fieldOf(row, p_.panels) == panel) rows.push_back(&row);
    }
    return rows;
  }

  /// Adds a block of data. \returns its name
  std::string addBlock(const std::string& lines) {
    std::string name = fmt::format("$data{}", ++block_count_);
    // gnuplot fails for a block without a point.
    blocks_ += fmt::format("{} << EOD\n{}EOD\n", name,
                           lines.empty() ? "NaN NaN NaN NaN NaN NaN NaN\n" : lines);
    return name;
  }

  bool isDrawn(double x, double y) const {
    return std::isfinite(x) && std::isfinite(y) && (!p_.log_x || x > 0.0) && (!p_.log_y || y > 0.0);
  }

  std::string panelCommand(const std::string& panel) {
    switch (p_.type) {
      case Type::kMap:
        return mapCommand(rowsWith(panel));
      case Type::kHistogram:
        return histogramCommand(rowsWith(panel));
      default:
        return linesCommand(rowsWith(panel));
    }
  }

  std::string linesCommand(const std::vector<const Fields*>& rows) {
    std::string command = "plot ";
    for (const std::string& line : valuesOf(p_.lines)) {
      std::map<double, double> points;  // by x
      for (const Fields* row : rows) {
        if (!p_.lines.empty() && fieldOf(*row, p_.lines) != line) continue;
        // What a diverged run measured, it measured until then only.
        if (place_.count("verdict") > 0 && fieldOf(*row, "verdict") == "diverged") continue;
        const double x = numberOf(*row, p_.x), y = numberOf(*row, p_.y);
        if (isDrawn(x, y)) points[x] = y;
      }
      std::string lines;
      for (const auto& [x, y] : points) lines += numberText(x) + ' ' + numberText(y) + '\n';
      command += fmt::format("{} using 1:2 with linespoints pointtype 7 pointsize 0.5 title {}, ",
                             addBlock(lines), gnuplotText(line));
    }
    return command + "\n";
  }

  /// The borders between neighbouring values, for cells of a map.
  std::map<double, std::pair<double, double>> cells(const std::vector<const Fields*>& rows,
                                                    const std::string& key, bool is_log) const {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const Fields* row : rows) values.push_back(numberOf(*row, key));
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    const auto position = [&](std::size_t i) { return is_log ? std::log10(values[i]) : values[i]; };
    std::map<double, std::pair<double, double>> result;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double here = position(i);
      const double before =
          i > 0 ? position(i - 1) : 2.0 * here - position(std::min(i + 1, values.size() - 1));
      const double after = i + 1 < values.size() ? position(i + 1) : 2.0 * here - before;
      double low = 0.5 * (before + here), high = 0.5 * (here + after);
      if (is_log) {
        low = std::pow(10.0, low);
        high = std::pow(10.0, high);
      }
      result[values[i]] = {low, high};
    }
    return result;
  }

  std::string mapCommand(const std::vector<const Fields*>& rows) {
    const auto columns = cells(rows, p_.x, p_.log_x);
    const auto lines = cells(rows, p_.y, p_.log_y);
    const bool is_verdict = p_.color == "verdict";
    std::map<std::string, std::string> boxes;  // by colour
    std::map<double, double> limits;
    for (const Fields* row : rows) {
      const double x = numberOf(*row, p_.x), y = numberOf(*row, p_.y);
      if (!isDrawn(x, y)) continue;
      const auto [left, right] = columns.at(x);
      const auto [bottom, top] = lines.at(y);
      const std::string& color = fieldOf(*row, p_.color);
      boxes[is_verdict ? color : ""] += fmt::format("{} {} {} {} {} {} {}\n", x, y, left, right,
                                                    bottom, top, is_verdict ? "0" : color);
      if (!p_.limit.empty()) limits[x] = numberOf(*row, p_.limit);
    }
    const std::string border =
        fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", columns.begin()->second.first,
                    columns.rbegin()->second.second, lines.begin()->second.first,
                    lines.rbegin()->second.second);
    return border + "plot " + boxCommands(boxes, is_verdict) + limitCommand(limits) + "\n";
  }

  std::string boxCommands(const std::map<std::string, std::string>& boxes, bool is_verdict) {
    constexpr const char* kBoxes =
        "{} using 1:2:3:4:5:6{} with boxxyerror fillstyle solid {} title {}, ";
    if (!is_verdict) {
      return fmt::format(kBoxes, addBlock(boxes.at("")), ":7", "linecolor palette", "''");
    }
    std::string command;
    for (const Shade& shade : kShades) {
      std::string lines;
      for (const auto& [verdict, cells] : boxes) {
        const bool is_bad = std::any_of(std::begin(kShades) + 1, std::end(kShades),
                                        [&v = verdict](const Shade& s) { return s.verdict == v; });
        if (is_bad ? verdict == shade.verdict : shade.verdict.empty()) lines += cells;
      }
      if (lines.empty()) continue;
      command +=
          fmt::format(kBoxes, addBlock(lines), "", fmt::format("linecolor rgb '{}'", shade.color),
                      gnuplotText(std::string(shade.label)));
    }
    return command;
  }

  std::string limitCommand(const std::map<double, double>& limits) {
    if (p_.limit.empty()) return {};
    std::string lines;
    for (const auto& [x, y] : limits) {
      if (isDrawn(x, y)) lines += numberText(x) + ' ' + numberText(y) + '\n';
    }
    return fmt::format("{} using 1:2 with lines linewidth 3 linecolor 'black' title {}",
                       addBlock(lines), gnuplotText(title_.at(p_.limit)));
  }

  std::string histogramCommand(const std::vector<const Fields*>& rows) {
    std::vector<double> values;
    for (const Fields* row : rows) {
      const double x = numberOf(*row, p_.x);
      if (isDrawn(x, 1.0)) values.push_back(x);
    }
    std::sort(values.begin(), values.end());
    if (values.empty()) return fmt::format("plot {} using 1:2 title 'no values'\n", addBlock(""));
    const auto position = [&](double x) { return p_.log_x ? std::log10(x) : x; };
    const auto value = [&](double x) { return p_.log_x ? std::pow(10.0, x) : x; };
    const double least = position(values.front());
    const double width =
        std::max(position(values.back()) - least, 1e-9) / static_cast<double>(kBins);
    std::vector<std::size_t> counts(kBins);
    for (const double x : values) {
      ++counts[std::min(static_cast<std::size_t>((position(x) - least) / width), kBins - 1)];
    }
    std::string boxes;
    for (std::size_t i = 0; i < kBins; ++i) {
      const double left = least + width * static_cast<double>(i);
      boxes += fmt::format("{} {} {} {} 0 {}\n", value(left + 0.5 * width), counts[i], value(left),
                           value(left + width), counts[i]);
    }
    const auto share = [&](double part) {
      return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
    };
    return fmt::format(
        "set yrange [0:*]\nplot {} using 1:2:3:4:5:6 with boxxyerror fillstyle solid linecolor rgb "
        "'#6baed6' title "
        "{}\n",
        addBlock(boxes),
        gnuplotText(fmt::format("{} cases, median {}, 95 % below {}", values.size(),
                                roundedText(share(0.5), 3), roundedText(share(0.95), 3))));
  }

  const Study& study_;
  const PlotOptions& p_ = study_.plot;
  std::vector<Fields> rows_;
  std::map<std::string, std::size_t> place_;  ///< of a key in a row
  std::map<std::string, std::string> title_;
  std::vector<std::string> commands_;
  std::string blocks_;
  int block_count_ = 0;
};

}  // namespace

std::string plotScript(const Study& study, const std::vector<std::string>& rows,
                       const std::string& path) {
  Plotter plotter(study, rows);
  std::string script = plotter.data() + plotter.axes();
  for (const char* const type : {"png", "svg"}) {
    const std::string terminal = std::string(type) == "png" ? "pngcairo" : "svg background 'white'";
    script += fmt::format("set terminal {} size {} font 'sans,11'\nset output {}\n", terminal,
                          plotter.size(), gnuplotText(path + "." + type));
    script += plotter.picture() + "unset output\n";
  }
  return script;
}

void drawPlot(const Study& study, const std::vector<std::string>& rows, const std::string& path) {
  const std::string script = plotScript(study, rows, path);
  FILE* const gnuplot = ::popen("gnuplot", "w");  // NOLINT(cert-env33-c): a fixed command
  if (gnuplot == nullptr) throw FileError("gnuplot: could not be started");
  const bool is_written = std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  if (::pclose(gnuplot) == 0 && is_written) return;
  throw FileError(path + ".png: could not be drawn by gnuplot, which --plot needs");
}

}  // namespace spring_pendulum::sweep
