#include "io/column_roles.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "io/input_file.hpp"
#include "io/row_parser.hpp"

namespace taut::detail {
namespace {

// Words that stand before the component's letter or number. A table may hold several such families; the first listed
// here that is complete is taken.
constexpr std::array<std::string_view, 11> kCoordinatePrefixes = {
    "", "x", "points", "point", "coordinates", "coordinate", "coords", "coord", "position", "pos", "p"};
constexpr std::array<std::string_view, 5> kNormalPrefixes = {"normals", "normal", "norm", "nrm", "n"};
// They stand in for the letters that the header does not have.
constexpr std::array<std::pair<std::string_view, int>, 7> kSurveyorsNames = {
    {{"easting", 0}, {"east", 0}, {"northing", 1}, {"north", 1}, {"elevation", 2}, {"altitude", 2}, {"height", 2}}};

/// One column's place in a family such as Points_0 Points_1 Points_2.
struct Place {
  bool of_normal = false;
  std::size_t prefix = 0;  // index into the list above
  bool numbered = false;   // by numbers, not by letters
  int component = 0;       // from 0 for letters; as written for numbers
};

/// The name in lower case without a unit in brackets behind it: "X [m]" -> "x". A number in brackets stays: "x[0]" ->
/// "x0".
std::string without_unit(std::string_view name) {
  std::string text = lower(name);
  const std::size_t open = text.find_first_of("[(");
  if (open == std::string::npos || open == 0) return text;
  const std::string inside = text.substr(open + 1, text.find_first_of("])", open) - open - 1);
  const bool number = !inside.empty() && inside.find_first_not_of("0123456789") == std::string::npos;
  text.resize(open);
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return number ? text + inside : text;
}

/// "y" -> 1, "12" -> 12; nothing else is a component.
std::optional<Place> component_of(std::string_view text) {
  constexpr std::string_view kLetters = "xyzw";
  if (text.size() == 1 && kLetters.find(text[0]) != kLetters.npos) {
    return Place{.component = static_cast<int>(kLetters.find(text[0]))};
  }
  int number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool digits =
      !text.empty() && text[0] >= '0' && text[0] <= '9' && error == std::errc{} && stop == text.data() + text.size();
  return digits ? std::optional(Place{.numbered = true, .component = number}) : std::nullopt;
}

std::optional<Place> place_after(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return std::nullopt;
  std::string_view rest = name.substr(prefix.size());
  const std::size_t skipped = std::min(rest.find_first_not_of("_:.- "), rest.size());
  if (prefix.empty() && skipped > 0) return std::nullopt;
  const auto place = component_of(rest.substr(skipped));
  // "xx" is no coordinate, and a bare number names nothing.
  if (place && (prefix == "x" ? !place->numbered : prefix.empty() && place->numbered)) return std::nullopt;
  return place;
}

std::optional<Place> place_of(std::string_view written) {
  std::string name = without_unit(written);
  // "x_coord", "x coordinate": the letter in front.
  for (const std::string_view word : {"coordinate", "coord", "position", "pos"}) {
    if (name.size() >= word.size() + 1 && name.size() <= word.size() + 2 && name.ends_with(word)) {
      name = std::string(word) + name[0];
    }
  }
  for (std::size_t i = 0; i < kCoordinatePrefixes.size(); ++i) {
    if (auto place = place_after(name, kCoordinatePrefixes[i])) {
      place->prefix = i;
      return place;
    }
  }
  for (std::size_t i = 0; i < kNormalPrefixes.size(); ++i) {
    if (auto place = place_after(name, kNormalPrefixes[i])) {
      place->of_normal = true;
      place->prefix = i;
      return place;
    }
  }
  return std::nullopt;
}

/// Component and column of each member, by the index of the family's prefix and whether numbers tell its members apart.
using Families = std::map<std::pair<std::size_t, bool>, std::vector<std::pair<int, std::size_t>>>;

void add_surveyors_names(const std::vector<std::string_view>& names, Families& coordinates) {
  constexpr std::pair<std::size_t, bool> kBareLetters = {0, false};
  auto letters = coordinates.contains(kBareLetters) ? coordinates[kBareLetters] : Families::mapped_type();
  for (std::size_t column = 0; column < names.size(); ++column) {
    const std::string name = without_unit(names[column]);
    for (const auto& [word, component] : kSurveyorsNames) {
      const bool taken = std::any_of(letters.begin(), letters.end(),
                                     [&, place = component](const auto& member) { return member.first == place; });
      if (name == word && !taken) letters.emplace_back(component, column);
    }
  }
  if (!letters.empty()) coordinates[kBareLetters] = std::move(letters);
}

/// The columns of a family by component; empty unless they are x y ..., or numbered 0, 1, ... or 1, 2, ..., each once.
std::vector<std::size_t> in_order(std::vector<std::pair<int, std::size_t>> family, bool numbered) {
  std::sort(family.begin(), family.end());
  const int first = family.front().first;
  std::vector<std::size_t> columns;
  for (const auto& [component, column] : family) {
    if (first > (numbered ? 1 : 0) || component != first + static_cast<int>(columns.size())) return {};
    columns.push_back(column);
  }
  return columns;
}

}  // namespace

ColumnRoles roles_from_header(const std::vector<std::string_view>& names) {
  Families coordinates;
  Families normals;
  for (std::size_t column = 0; column < names.size(); ++column) {
    const auto place = place_of(names[column]);
    if (!place) continue;
    auto& families = place->of_normal ? normals : coordinates;
    families[{place->prefix, place->numbered}].emplace_back(place->component, column);
  }
  add_surveyors_names(names, coordinates);
  ColumnRoles roles;
  roles.some_named = !coordinates.empty() || !normals.empty();
  for (const auto& [family, members] : coordinates) {
    roles.coordinates = in_order(members, family.second);
    if (roles.coordinates.size() >= 2) break;
    roles.coordinates.clear();
  }
  for (const auto& [family, members] : normals) {
    roles.normals = in_order(members, family.second);
    if (!roles.coordinates.empty() && roles.normals.size() == roles.coordinates.size()) break;
    roles.normals.clear();
  }
  for (std::size_t column = 0; column < names.size(); ++column) {
    const auto holds = [&](const std::vector<std::size_t>& list) {
      return std::find(list.begin(), list.end(), column) != list.end();
    };
    if (!holds(roles.coordinates) && !holds(roles.normals)) roles.others.push_back(column);
    const std::string name = without_unit(names[column]);
    for (const std::string_view angle : {"lat", "latitude", "lon", "long", "lng", "longitude"}) {
      roles.angles = roles.angles || (roles.coordinates.empty() && name == angle);
    }
  }
  return roles;
}

bool is_header(const std::vector<std::string_view>& fields) {
  // ... or like the name of a sample, @17.
  const auto begins_like_a_number = [](std::string_view field) {
    const auto first = field.find_first_not_of("+-.@");
    return first != std::string_view::npos && field[first] >= '0' && field[first] <= '9';
  };
  return !std::all_of(fields.begin(), fields.end(), is_number) &&
         std::none_of(fields.begin(), fields.end(), begins_like_a_number);
}

std::string list_columns(const std::vector<std::string_view>& names, const std::vector<std::size_t>& columns) {
  constexpr std::size_t kShown = 6;
  std::string list = columns.size() == 1 ? "column " : "columns ";
  for (std::size_t i = 0; i < std::min(kShown, columns.size()); ++i) {
    list += (i > 0 ? ", " : "") + quote(names[columns[i]]);
  }
  return columns.size() > kShown ? list + " and " + std::to_string(columns.size() - kShown) + " more" : list;
}

}  // namespace taut::detail
