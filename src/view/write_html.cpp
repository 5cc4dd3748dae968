#include "taut/view/write_scene.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "taut/io/output_file.hpp"
#include "view/encode.hpp"
#include "view/encode_png.hpp"
#include "view/legend.hpp"
#include "view/page_text.hpp"
#include "view/picture.hpp"
#include "view/shading.hpp"

namespace taut {
namespace {

using detail::css_colour;
using detail::escape_xml;
using detail::Stage;

/// Builds JSON text for the inside of a script element.
class Json {
 public:
  Json& open(char bracket) {
    comma();
    text_.push_back(bracket);
    first_ = true;
    return *this;
  }
  Json& close(char bracket) {
    text_.push_back(bracket);
    first_ = false;
    return *this;
  }
  Json& key(std::string_view name) {
    string(name);
    text_.push_back(':');
    first_ = true;
    return *this;
  }
  Json& string(std::string_view value) {
    comma();
    text_.push_back('"');
    for (const char c : detail::clean_utf8(value)) {
      switch (c) {
        case '"': text_ += "\\\""; break;
        case '\\': text_ += "\\\\"; break;
        case '\n': text_ += "\\n"; break;
        case '\t': text_ += "\\t"; break;
        case '<': text_ += "\\u003c"; break;  // no tag can begin inside the script element
        default: text_.push_back(c);
      }
    }
    text_.push_back('"');
    return *this;
  }
  Json& number(double value) {
    comma();
    std::array<char, 32> digits{};
    text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
    return *this;
  }
  Json& boolean(bool value) {
    comma();
    text_ += value ? "true" : "false";
    return *this;
  }
  Json& null() {
    comma();
    text_ += "null";
    return *this;
  }
  Json& vector(const Eigen::Vector3d& x) {
    open('[');
    for (const double value : x) number(value);
    return close(']');
  }
  /// Little-endian 32-bit numbers in base64.
  template <class Matrix>
  Json& block(const Matrix& matrix) {
    static_assert(sizeof(typename Matrix::Scalar) == 4);
    std::string bytes;
    bytes.reserve(4 * static_cast<std::size_t>(matrix.size()));
    for (Index i = 0; i < matrix.size(); ++i) {
      const auto bits = std::bit_cast<std::uint32_t>(matrix.data()[i]);
      for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(bits >> shift & 255));
    }
    return string(detail::base64(bytes));
  }
  std::string take() { return std::move(text_); }

 private:
  void comma() {
    if (!first_) text_.push_back(',');
    first_ = false;
  }
  std::string text_;
  bool first_ = true;
};

void write_scalar(Json& json, const Stage& stage) {
  json.key("scalar");
  if (stage.scalar_name.empty()) {
    json.null();
    return;
  }
  constexpr int kIsolines = 12;
  constexpr int kTicks = 4;
  const double range = stage.scalar_max - stage.scalar_min;
  json.open('{').key("name").string(stage.scalar_name);
  json.key("min").number(stage.scalar_min).key("max").number(stage.scalar_max);
  json.key("step").number(detail::nice_step(range, kIsolines));
  json.key("isolines").boolean(detail::draws_isolines(stage)).key("ticks").open('[');
  const double step = detail::nice_step(range, kTicks);
  for (double k = std::ceil(stage.scalar_min / step - 1e-6); k * step <= stage.scalar_max + 1e-6 * range; ++k) {
    json.open('[').number(k * step).string(detail::format_number(k * step, 6)).close(']');
  }
  json.close(']').close('}');
}

void write_meshes(Json& json, const Stage& stage) {
  json.key("meshes").open('[');
  for (const detail::StageMesh& mesh : stage.meshes) {
    json.open('{').key("name").string(mesh.name).key("colour").string(css_colour(mesh.colour));
    json.key("positions").block(mesh.positions).key("normals").block(mesh.normals).key("faces").block(mesh.faces);
    if (mesh.scalar.size() > 0) json.key("scalar").block(mesh.scalar);
    if (mesh.colours.size() > 0) json.key("colours").block(mesh.colours);
    json.close('}');
  }
  json.close(']').key("lines").open('[');
  for (const detail::StageLines& lines : stage.lines) {
    json.open('{').key("name").string(lines.name).key("colour").string(css_colour(lines.colour));
    json.key("positions").block(lines.positions).key("segments").block(lines.segments).close('}');
  }
  json.close(']');
}

void write_paths(Json& json, const Stage& stage) {
  json.key("paths").open('[');
  for (const detail::StagePath& path : stage.paths) {
    json.open('{').key("label").string(path.label).key("colour").string(css_colour(path.colour));
    json.key("width").number(path.width).key("failed").boolean(path.failed);
    json.key("positions").block(path.positions).close('}');
  }
  json.close(']').key("points").open('[');
  for (const detail::StagePoint& point : stage.points) {
    json.open('{').key("label").string(point.label).key("colour").string(css_colour(point.colour));
    json.key("size").number(point.size).key("at").vector(point.position.cast<double>()).close('}');
  }
  json.close(']');
}

void write_legend(Json& json, const Stage& stage) {
  json.key("legend").open('[');
  for (const detail::LegendLine& line : detail::make_legend(stage)) {
    const char* mark = line.mark == detail::LegendMark::line     ? "line"
                       : line.mark == detail::LegendMark::dashes ? "dashes"
                                                                 : "square";
    json.open('{').key("mark").string(mark).key("colour").string(css_colour(line.colour));
    json.key("text").string(line.text).key("value").string(line.value).close('}');
  }
  json.close(']');
}

std::string scene_json(const Stage& stage, const Eigen::Vector3d& view) {
  Json json;
  json.open('{').key("format").number(1).key("flat").boolean(stage.flat);
  json.key("origin")
      .vector(stage.origin)
      .key("radius")
      .number(stage.radius)
      .key("up")
      .vector(stage.up)
      .key("view")
      .vector(view);
  json.key("colourMap").open('[');
  for (const Colour& colour : detail::kViridis) json.string(css_colour(colour));
  json.close(']');
  write_scalar(json, stage);
  write_meshes(json, stage);
  write_paths(json, stage);
  write_legend(json, stage);
  json.key("dash").number(detail::kDash * stage.radius).key("dashGap").number(detail::kDashGap * stage.radius);
  json.key("cells");
  if (stage.cell_centres.cols() > 0) {
    json.open('{').key("size").number(stage.cell_size).key("colour").string(css_colour(stage.cell_colour));
    json.key("shown").boolean(stage.cells_shown).key("centres").block(stage.cell_centres).close('}');
  } else {
    json.null();
  }
  return json.close('}').take();
}

using Values = std::array<std::pair<std::string_view, std::string>, 7>;

/// The template with each {{name}} replaced; what is put in is not looked at again.
std::string fill_in(std::string_view text, const Values& values) {
  std::string out;
  while (true) {
    const std::size_t start = text.find("{{");
    out += text.substr(0, start);
    if (start == std::string_view::npos) return out;
    const std::size_t end = text.find("}}", start);
    const std::string_view name = text.substr(start + 2, end - start - 2);
    for (const auto& [key, value] : values) {
      if (key == name) out += value;
    }
    text.remove_prefix(end + 2);
  }
}

}  // namespace

std::string to_html(const Scene& scene) {
  const Stage stage = detail::make_stage(scene);
  PictureOptions still{.width = 900, .height = 600};
  still.towards_viewer = detail::viewer_of(stage, still);
  std::string facts;
  for (const SceneFact& fact : scene.facts) {
    facts.append("<dt>")
        .append(escape_xml(fact.name))
        .append("</dt><dd>")
        .append(escape_xml(fact.value))
        .append("</dd>");
  }
  std::string caption;
  for (const std::string& line : stage.caption) caption.append("<p>").append(escape_xml(line)).append("</p>");
  std::string still_url = "data:image/png;base64,";
  still_url += detail::base64(detail::encode_png(detail::still_image(stage, still), false));
  return fill_in(detail::kPageHtml, Values{{{"title", escape_xml(scene.title.empty() ? "Taut" : scene.title)},
                                            {"style", std::string(detail::kPageCss)},
                                            {"script", std::string(detail::kPageJs)},
                                            {"still", std::move(still_url)},
                                            {"facts", std::move(facts)},
                                            {"caption", std::move(caption)},
                                            {"scene", scene_json(stage, still.towards_viewer)}}});
}

void write_html(const std::string& path, const Scene& scene) { write_text(path, to_html(scene)); }

}  // namespace taut
