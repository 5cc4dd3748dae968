#pragma once

#include "report.hpp"
#include "study.hpp"

namespace taut::paper {

// What the paper's introduction and conclusions name geodesics for, each as a small real result.
void write_remeshing(Study& study, Section& section);
void write_winding(Study& study, Section& section);
void write_inertia(Study& study, Section& section);
void write_bending_invariant(Study& study, Section& section);
void write_motion_planning(Study& study, Section& section);
void write_isomap(Study& study, Section& section);
void write_length_measurement(Study& study, Section& section);

}  // namespace taut::paper
