#include "applications.hpp"

#include <fmt/format.h>

#include "parts.hpp"
#include "taut/core/error.hpp"

namespace taut::paper {

void write_applications(Study& study, Report& report) {
  Section& section = report.section("Applications");
  section.paper(
      "The introduction and the conclusions name what geodesics are wanted for: surface remeshing, filament winding, "
      "inertia "
      "matrices, bending invariants, motion planning, Isomap, manifold interpolation, and the measurement of lengths. "
      "The "
      "paper shows none of them.");
  struct Application {
    const char* heading;
    void (*write)(Study&, Section&);
  };
  constexpr Application kApplications[] = {
      {"Surface remeshing", write_remeshing},           {"Filament winding", write_winding},
      {"Inertia matrix from geodesics", write_inertia}, {"Bending invariant", write_bending_invariant},
      {"Motion planning", write_motion_planning},       {"Isomap and manifold interpolation", write_isomap},
      {"Length measurement", write_length_measurement}};
  for (const Application& application : kApplications) {
    study.context.check_cancelled();
    section.subheading(application.heading);
    try {
      application.write(study, section);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      section.failed(escape_markup(error.what()));
    }
  }
}

}  // namespace taut::paper
