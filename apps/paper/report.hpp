#pragma once

#include <filesystem>
#include <list>
#include <string>
#include <vector>

#include "chart.hpp"
#include "drawing.hpp"
#include "table.hpp"
#include "taut/view/scene.hpp"
#include "taut/view/write_scene.hpp"

namespace taut::paper {

/// A picture in both its forms.
struct Figure {
  std::string name;     ///< of its files, without extension
  std::string caption;  ///< HTML
  std::string svg;
  std::string png;  ///< bytes; empty where none can be made
};

[[nodiscard]] Figure figure_of(std::string name, std::string caption, const Drawing& drawing);
[[nodiscard]] Figure figure_of(std::string name, std::string caption, const Chart& chart);
[[nodiscard]] Figure figure_of(std::string name, std::string caption, const Scene& scene,
                               const PictureOptions& options = {.width = 900, .height = 620});

/// What is told under one heading, in order. Texts are HTML.
class Section {
 public:
  explicit Section(std::string heading) : heading_(std::move(heading)) {}

  /// What the paper states, in our own words.
  void paper(const std::string& text) { box("paper", "The paper", text); }
  /// What came out here.
  void measured(const std::string& text) { box("measured", "Measured", text); }
  /// Where the paper is silent, or where the numbers say otherwise.
  void remark(const std::string& text) { box("remark", "Remark", text); }
  /// Why something is not there.
  void failed(const std::string& text);
  void text(const std::string& text) { html_ += "<p>" + text + "</p>\n"; }
  void subheading(const std::string& text) { html_ += "<h3>" + text + "</h3>\n"; }
  void add(Table table);
  void add(Figure figure);
  /// Small pictures side by side.
  void add_row(std::vector<Figure> figures);

  [[nodiscard]] const std::string& heading() const { return heading_; }
  [[nodiscard]] bool has_failed() const { return has_failed_; }

 private:
  friend class Report;
  void box(const char* kind, const char* name, const std::string& text);
  void append_picture(const Figure& figure);

  std::string heading_;
  std::string html_;
  std::vector<Table> tables_;
  std::vector<Figure> figures_;
  bool has_failed_ = false;
};

/// The whole: one page that needs nothing else, and beside it every figure and every table as files.
class Report {
 public:
  /// The section of that heading, made at the end when there is none yet. Stays where it is in memory.
  Section& section(const std::string& heading);
  [[nodiscard]] bool has_failed() const;

  /// Writes report.html, report.json, figures/NAME.svg, figures/NAME.png, data/NAME.csv and data/NAME.json.
  /// `preface` (HTML) says how it was made. Throws IoError.
  void write(const std::filesystem::path& folder, const std::string& preface) const;

 private:
  std::list<Section> sections_;
};

/// Makes `folder` and the folders in it, and sees that files can be written there. Throws IoError.
void prepare_report_folder(const std::filesystem::path& folder);

}  // namespace taut::paper
