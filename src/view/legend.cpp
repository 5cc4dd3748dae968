#include "view/legend.hpp"

#include <algorithm>

namespace taut::detail {
namespace {

constexpr std::size_t kMostLines = 8;

/// Paths that share a line.
struct Group {
  const StagePath* first;
  std::size_t count = 0;
  double shortest = 0;
  double longest = 0;

  void add(const StagePath& path) {
    shortest = count == 0 ? path.length : std::min(shortest, path.length);
    longest = count == 0 ? path.length : std::max(longest, path.length);
    ++count;
  }

  [[nodiscard]] std::string value() const {
    if (count == 1) return "length " + format_number(shortest, 10);
    return std::to_string(count) + " paths, lengths " + format_number(shortest, 6) + " to " + format_number(longest, 6);
  }
};

}  // namespace

std::vector<LegendLine> make_legend(const Stage& stage) {
  std::vector<Group> groups;
  for (const StagePath& path : stage.paths) {
    auto group = std::ranges::find_if(groups, [&](const Group& g) {
      return g.first->label == path.label && g.first->colour == path.colour && g.first->failed == path.failed;
    });
    if (group == groups.end()) group = groups.insert(group, Group{&path});
    group->add(path);
  }
  const bool cells = stage.cells_shown && stage.cell_centres.cols() > 0;
  const std::size_t room = kMostLines - (cells ? 1 : 0);
  std::vector<LegendLine> lines;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups.size() > room && i + 1 >= room) {
      Group rest{groups[i].first};
      for (const Group& group : std::vector<Group>(groups.begin() + static_cast<std::ptrdiff_t>(i), groups.end())) {
        rest.count += group.count;
        rest.shortest = rest.shortest == 0 ? group.shortest : std::min(rest.shortest, group.shortest);
        rest.longest = std::max(rest.longest, group.longest);
      }
      lines.push_back({LegendMark::line, rest.first->colour, "others", rest.value()});
      break;
    }
    const StagePath& first = *groups[i].first;
    const std::string name = first.label.empty() ? "path" : first.label;
    lines.push_back({first.failed ? LegendMark::dashes : LegendMark::line, first.colour, name, groups[i].value()});
  }
  if (cells) {
    lines.push_back({LegendMark::square, stage.cell_colour, stage.cell_label,
                     std::to_string(stage.cell_centres.cols()) + " of size " + format_number(stage.cell_size, 4)});
  }
  return lines;
}

}  // namespace taut::detail
