// What is known of one pair of points, brought up to date. Efforts add up over all rungs and boxes, also those in vain.
#include "search/inquiry.hpp"

namespace taut::detail {

void Inquiry::note(const Starts& starts, GridMethod grid) {
  blank.cell = starts.cell;
  blank.marched = starts.marched;
  blank.walked_cells = starts.walked;
  if (starts.cells) {
    blank.num_cells = starts.cells->num_cells();
    blank.num_layers = starts.cells->num_layers();
    blank.grid = grid;
  }
  blank.seconds.cells += starts.seconds.cells;
  blank.seconds.march += starts.seconds.march;
}

void Inquiry::give_up(Status status, Obstacle::Kind why) {
  best = blank;
  best->status = status;
  best->obstacle = {why};
  doubts = {};
}

void Inquiry::add_effort(const PathResult& other) {
  blank.seconds.cells += other.seconds.cells;
  blank.seconds.march += other.seconds.march;
  blank.seconds.correct += other.seconds.correct;
  rungs.insert(rungs.end(), other.rungs.begin(), other.rungs.end());
}

void Inquiry::report(Rung rung) {
  RungReport report{.rung = rung, .cell = blank.cell, .num_cells = blank.num_cells, .doubts = doubts};
  if (has_path()) report.length = best->length;
  rungs.push_back(report);
}

}  // namespace taut::detail
