#pragma once

#include <string>
#include <vector>

#include "report.hpp"
#include "study.hpp"

namespace taut::paper {

/// One thing to ask `taut paper` for.
struct Part {
  std::string name;                   ///< "figure5"
  std::vector<std::string> headings;  ///< of the sections it writes
  void (*run)(Study& study, Report& report);
};

/// All of them, in the order of the report.
[[nodiscard]] const std::vector<Part>& parts();

// Each writes the sections of one part. Throw what the library throws.
void write_figure1(Study& study, Report& report);
void write_figure2(Study& study, Report& report);
void write_figure3(Study& study, Report& report);
void write_figure4(Study& study, Report& report);
void write_figure5(Study& study, Report& report);
void write_figure6(Study& study, Report& report);
void write_figure7(Study& study, Report& report);
void write_table(Study& study, Report& report);
void write_high_dimension(Study& study, Report& report);
void write_applications(Study& study, Report& report);
void write_representations(Study& study, Report& report);
void write_appendix1(Study& study, Report& report);
void write_appendix2(Study& study, Report& report);

}  // namespace taut::paper
