#include "parts.hpp"

namespace taut::paper {

const std::vector<Part>& parts() {
  static const std::vector<Part> all = {
      {"figure1", {"Figure 1"}, write_figure1},
      {"figure2", {"Figure 2"}, write_figure2},
      {"figure3",
       {"Figure 3", "Figure 4"},
       [](Study& study, Report& report) {
         write_figure3(study, report);
         write_figure4(study, report);
       }},
      {"figure5", {"Figure 5"}, write_figure5},
      {"figure6", {"Figure 6"}, write_figure6},
      {"figure7", {"Figure 7"}, write_figure7},
      {"table", {"Table"}, write_table},
      {"dimensions", {"High dimension"}, write_high_dimension},
      {"applications", {"Applications"}, write_applications},
      {"representations", {"Other representations"}, write_representations},
      {"appendix1", {"Appendix I"}, write_appendix1},
      {"appendix2", {"Appendix II"}, write_appendix2},
  };
  return all;
}

}  // namespace taut::paper
