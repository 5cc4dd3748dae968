#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "report_text.hpp"
#include "taut/core/error.hpp"
#include "taut/io/output_file.hpp"

namespace taut::paper {
namespace {

/// "Appendix I" as "appendix-i": the anchor of a heading.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    anchor += std::isalnum(static_cast<unsigned char>(c)) != 0
                  ? static_cast<char>(std::tolower(static_cast<unsigned char>(c)))
                  : '-';
  }
  return anchor;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError(folder.string(), "cannot be made: " + error.message());
}

}  // namespace

Figure figure_of(std::string name, std::string caption, const Drawing& drawing) {
  return {std::move(name), std::move(caption), to_svg(drawing), to_png(drawing)};
}

Figure figure_of(std::string name, std::string caption, const Chart& chart) {
  return figure_of(std::move(name), std::move(caption), draw(chart));
}

Figure figure_of(std::string name, std::string caption, const Scene& scene, const PictureOptions& options) {
  return {std::move(name), std::move(caption), taut::to_svg(scene, options), taut::to_png(scene, options)};
}

void Section::box(const char* kind, const char* name, const std::string& text) {
  html_ += fmt::format("<div class=\"box {}\"><div class=\"name\">{}</div><div>{}</div></div>\n", kind, name, text);
}

void Section::failed(const std::string& text) {
  has_failed_ = true;
  box("failed", "Failed", text);
}

void Section::add(Table table) {
  html_ += to_html(table);
  tables_.push_back(std::move(table));
}

void Section::append_picture(const Figure& figure) {
  // Inline, so that the page needs no other file and its text can be searched.
  html_ += "<figure class=\"picture\">" + figure.svg + "<figcaption>" + figure.caption +
           fmt::format(" <span class=\"files\"><a class=\"file\" href=\"figures/{0}.svg\">SVG</a>", figure.name) +
           (figure.png.empty() ? "" : fmt::format(" <a class=\"file\" href=\"figures/{0}.png\">PNG</a>", figure.name)) +
           "</span></figcaption></figure>\n";
}

void Section::add(Figure figure) {
  append_picture(figure);
  figures_.push_back(std::move(figure));
}

void Section::add_row(std::vector<Figure> figures) {
  html_ += "<div class=\"row\">\n";
  for (Figure& figure : figures) add(std::move(figure));
  html_ += "</div>\n";
}

Section& Report::section(const std::string& heading) {
  const auto found = std::ranges::find(sections_, heading, &Section::heading);
  if (found != sections_.end()) return *found;
  return sections_.emplace_back(heading);
}

bool Report::has_failed() const { return std::ranges::any_of(sections_, &Section::has_failed); }

void Report::write(const std::filesystem::path& folder, const std::string& preface) const {
  prepare_report_folder(folder);
  std::string contents;
  std::string body;
  nlohmann::ordered_json json;
  for (const Section& section : sections_) {
    const std::string anchor = anchor_of(section.heading());
    contents += fmt::format("<a href=\"#{}\">{}</a>\n", anchor, section.heading());
    body += fmt::format("<section><h2 id=\"{}\">{}</h2>\n{}</section>\n", anchor, section.heading(), section.html_);
    nlohmann::ordered_json& tables = json[section.heading()] = nlohmann::ordered_json::object();
    for (const Table& table : section.tables_) {
      tables[table.name] = to_json(table);
      write_text(folder / "data" / (table.name + ".csv"), to_csv(table));
      write_text(folder / "data" / (table.name + ".json"), to_json(table).dump(1) + "\n");
    }
    for (const Figure& figure : section.figures_) {
      write_text(folder / "figures" / (figure.name + ".svg"), figure.svg);
      if (!figure.png.empty()) write_text(folder / "figures" / (figure.name + ".png"), figure.png);
    }
  }
  write_text(folder / "report.json", json.dump(1) + "\n");
  write_text(
      folder / "report.html",
      fmt::format("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
                  "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                  "<link rel=\"icon\" href=\"data:,\">\n"
                  "<title>Geodesic computation on implicit surfaces, measured</title>\n<style>\n{}</style></head>\n"
                  "<body><main>\n<h1>Geodesic computation on implicit surfaces, measured</h1>\n{}\n"
                  "<nav>\n{}</nav>\n{}</main></body></html>\n",
                  kReportStyle, preface, contents, body));
}

void prepare_report_folder(const std::filesystem::path& folder) {
  for (const auto& place : {folder, folder / "figures", folder / "data"}) make_folder(place);
  // A folder that is there may still refuse files.
  const OutputFile probe(folder / "report.html");
}

}  // namespace taut::paper
