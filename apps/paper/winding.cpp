// Filament winding (Seereeram and Wen): fibres laid along geodesics do not slip.

#include <fmt/format.h>

#include "applications.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/formula.hpp"
#include "winding_pattern.hpp"

#include <numbers>

namespace taut::paper {

void write_winding(Study& study, Section& section) {
  // A pressure vessel: a barrel of radius 1 with domed ends.
  const Surface vessel = parse_surface("x^2+y^2+(z/1.7)^4=1");
  Table table{.name = "winding",
              .title = "Closed patterns on the vessel x² + y² + (z / 1.7)⁴ = 1",
              .columns = {{"circuits"},
                          {"turns round the axis"},
                          {"winding angle, °", "{:.9f}"},
                          {"polar opening, radius", "{:.6f}"},
                          {"fibre length", "{:.9f}"},
                          {"closing miss", "{:.1e}"},
                          {"closing turn, rad", "{:.1e}"},
                          {"change of Clairaut’s constant", "{:.1e}"},
                          {"seconds", "{:.2f}"}}};
  std::vector<Figure> pictures;
  constexpr double kAngle = 0.42;  // radians, before it is adjusted
  for (const int circuits : {7, 31}) {
    const ProcessorClock clock;
    const WindingPattern pattern = close_winding(vessel, 1, kAngle, circuits, study.context);
    table.add({static_cast<Index>(circuits), static_cast<Index>(pattern.num_turns),
               pattern.angle * 180 / std::numbers::pi, std::sin(pattern.angle), pattern.length, pattern.closing_miss,
               pattern.closing_turn, pattern.clairaut_spread, clock.seconds()});
    Scene scene;
    scene.title = fmt::format("{} circuits", circuits);
    scene.meshes.push_back({.mesh = display_mesh(vessel, {}, study.context), .colour = Colour::hex(0xe6e3da)});
    scene.paths.push_back({.points = pattern.fibre,
                           .label = "fibre",
                           .colour = Colour::hex(0x8a4b14),
                           .length = pattern.length,
                           .width = circuits > 10 ? 0.5 : 0.9});
    pictures.push_back(figure_of(fmt::format("winding_{}", circuits),
                                 fmt::format("A fibre that closes after {} circuits.", circuits), scene,
                                 {.width = 560, .height = 640, .towards_viewer = {0.7, -0.6, 0.45}}));
  }
  section.text(
      "A fibre laid along a geodesic does not slip, whatever its tension. On a vessel of revolution it swings between "
      "two polar "
      "openings; the winding angle is tuned until the pattern closes, so that the fibres cover the equator evenly.");
  section.add_row(std::move(pictures));
  section.add(std::move(table));
}

}  // namespace taut::paper
