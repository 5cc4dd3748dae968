#pragma once

#include <string>
#include <vector>

namespace taut::paper {

/// Bodies for the paper's Figures 6 and 7, as formulas. Lengths in hand widths or so; z is up, y points to the back.
[[nodiscard]] std::string hand_formula();       ///< a right hand, palm towards -y; genus 0
[[nodiscard]] std::string pot_formula();        ///< a watering pot: a handle, and a stay from spout to body; genus 2
[[nodiscard]] std::string sculpture_formula();  ///< two rings that lean on each other, on a plinth; genus 2
/// A face that looks towards -y: a height over the plane of x and z, to be cut by `face_domain`.
[[nodiscard]] std::string face_formula();
[[nodiscard]] std::string face_domain();

}  // namespace taut::paper
