#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "taut/view/scene.hpp"

namespace taut::detail {

// The light of pictures; page.js holds the same in GLSL. Colours are linear inside and sRGB outside.

using Rgb = Eigen::Array3f;

inline float to_linear(float s) { return s <= 0.04045F ? s / 12.92F : std::pow((s + 0.055F) / 1.055F, 2.4F); }
inline float to_srgb(float l) {
  l = std::clamp(l, 0.0F, 1.0F);
  return l <= 0.0031308F ? 12.92F * l : 1.055F * std::pow(l, 1 / 2.4F) - 0.055F;
}
inline Rgb to_linear(const Colour& c) { return {to_linear(c.red), to_linear(c.green), to_linear(c.blue)}; }

/// The viridis colour map (van der Walt and Smith 2015, CC0) at every tenth of its way, sRGB; linear between them it is
/// within 0.01.
inline constexpr std::array<Colour, 11> kViridis = {Colour::hex(0x440154), Colour::hex(0x482475), Colour::hex(0x414487),
                                                    Colour::hex(0x355F8D), Colour::hex(0x2A788E), Colour::hex(0x21918C),
                                                    Colour::hex(0x22A884), Colour::hex(0x44BF70), Colour::hex(0x7AD151),
                                                    Colour::hex(0xBDDF26), Colour::hex(0xFDE725)};

/// Viridis at t, clamped to 0..1, sRGB.
inline Colour viridis(float t) {
  const float x = std::clamp(t, 0.0F, 1.0F) * (kViridis.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), kViridis.size() - 2);
  const float f = x - static_cast<float>(i);
  const Colour& a = kViridis[i];
  const Colour& b = kViridis[i + 1];
  return {a.red + f * (b.red - a.red), a.green + f * (b.green - a.green), a.blue + f * (b.blue - a.blue)};
}

/// Viridis in 256 linear steps: what a rasteriser looks up for each sample.
inline const std::array<Rgb, 256>& linear_viridis() {
  static const std::array<Rgb, 256> table = [] {
    std::array<Rgb, 256> t;
    for (std::size_t i = 0; i < t.size(); ++i) t[i] = to_linear(viridis(static_cast<float>(i) / 255));
    return t;
  }();
  return table;
}

/// Light on a matt, slightly glossy surface. All directions in camera axes (right, up, towards the viewer), unit; the
/// normal may point either way. `base` is linear.
inline Rgb shade(const Rgb& base, Eigen::Vector3f normal, const Eigen::Vector3f& view, float gloss) {
  float facing = normal.dot(view);
  Rgb colour = base;
  if (facing < 0) {  // the inside: a little warmer and darker
    normal = -normal;
    facing = -facing;
    colour *= Rgb(0.80F, 0.72F, 0.64F);
  }
  const Eigen::Vector3f key = Eigen::Vector3f(-0.45F, 0.70F, 0.60F).normalized();
  const Eigen::Vector3f fill = Eigen::Vector3f(0.80F, 0.05F, 0.50F).normalized();
  const float key_light = std::max(0.0F, normal.dot(key));
  const float fill_light = std::max(0.0F, normal.dot(fill));
  const float sky = 0.5F + 0.5F * normal.y();
  const Rgb light = 0.84F * key_light * Rgb(1.0F, 0.98F, 0.95F) + 0.20F * fill_light * Rgb(0.85F, 0.93F, 1.0F) +
                    0.42F * (sky * Rgb(0.96F, 0.98F, 1.0F) + (1 - sky) * Rgb(0.58F, 0.57F, 0.58F));
  const float half = std::max(0.0F, normal.dot((key + view).normalized()));
  const float half_3 = half * half * half;
  const float half_12 = (half_3 * half_3) * (half_3 * half_3);
  const float shine = gloss * (half_12 * half_12) * (half_12 * half_12);  // the 48th power
  const float grazing = 1 - facing;
  const float rim = 1 - 0.38F * grazing * grazing * grazing;
  return colour * light * rim + shine;
}

}  // namespace taut::detail
