#include "surface/rbf/cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/parallel.hpp"
#include "surface/simd_dispatch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/rbf/cholesky.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Right-looking blocked factorisation. With the matrix cut into columns of kPanel: factor the panel's diagonal block,
// solve for the rows below it (L21 = A21 L11^-T), then subtract L21 L21^T from the rest, which is where the time goes:
// a matrix product of the packed panel with itself, in tiles that stay in registers.

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 8>;
using Vec = hn::Vec<Tag>;

/// Register tile: kVectors vectors of rows by kTileColumns columns. AVX-512 has 32 registers, the others 16.
constexpr std::size_t kVectors = 2;
#if HWY_TARGET <= HWY_AVX3
constexpr std::size_t kTileColumns = 12;
#else
constexpr std::size_t kTileColumns = 6;
#endif

std::size_t tile_rows() { return kVectors * hn::Lanes(Tag()); }
std::size_t tile_columns() { return kTileColumns; }

/// c (tile, leading dimension `stride`) -= a b^T, where `a` holds `depth` columns of tile_rows() entries and `b`
/// `depth` columns of kTileColumns.
HWY_INLINE void subtract_product(const double* HWY_RESTRICT a, const double* HWY_RESTRICT b, std::size_t depth,
                                 double* HWY_RESTRICT c, std::size_t stride) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  Vec sum[kVectors][kTileColumns];
  for (auto& row : sum) {
    for (auto& entry : row) entry = hn::Zero(d);
  }
  for (std::size_t k = 0; k < depth; ++k, a += kVectors * lanes, b += kTileColumns) {
    const Vec a0 = hn::LoadU(d, a);
    const Vec a1 = hn::LoadU(d, a + lanes);
    for (std::size_t j = 0; j < kTileColumns; ++j) {
      const Vec b_j = hn::Set(d, b[j]);
      sum[0][j] = hn::Add(sum[0][j], hn::Mul(a0, b_j));
      sum[1][j] = hn::Add(sum[1][j], hn::Mul(a1, b_j));
    }
  }
  for (std::size_t j = 0; j < kTileColumns; ++j) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      double* const p = c + j * stride + v * lanes;
      hn::StoreU(hn::Sub(hn::LoadU(d, p), sum[v][j]), d, p);
    }
  }
}

/// Rows [first, last) of the lower triangle of c -= p p^T. `packed_rows` and `packed_columns` hold p's rows in strips
/// of tile_rows() and kTileColumns, `depth` columns each, padded with zeros.
HWY_NOINLINE void update_rows(const double* packed_rows, const double* packed_columns, std::size_t depth,
                              std::size_t first, std::size_t last, double* c, std::size_t stride) {
  const std::size_t rows = tile_rows();
  double edge[kVectors * 8 * kTileColumns];
  for (std::size_t j = 0; j < last; j += kTileColumns) {
    const double* const b = packed_columns + j * depth;
    for (std::size_t i = std::max(first, j / rows * rows); i < last; i += rows) {
      const double* const a = packed_rows + i * depth;
      double* const tile = c + j * stride + i;
      const bool inside = i + rows <= last && i >= j + kTileColumns - 1;
      if (inside) {
        subtract_product(a, b, depth, tile, stride);
        continue;
      }
      std::fill(edge, edge + rows * kTileColumns, 0.0);
      subtract_product(a, b, depth, edge, rows);
      for (std::size_t jj = 0; jj < kTileColumns; ++jj) {
        for (std::size_t ii = 0; ii < rows; ++ii) {
          if (i + ii < last && j + jj <= i + ii) tile[jj * stride + ii] += edge[jj * rows + ii];
        }
      }
    }
  }
}

/// X = X L^-T for the rows [0, num_rows) of `x`, with the `width` x `width` lower triangle `l` of the same stride.
HWY_NOINLINE void solve_rows(const double* l, std::size_t width, std::size_t stride, double* x, std::size_t num_rows) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  constexpr std::size_t kStrip = 4;
  std::size_t row = 0;
  for (; row + kStrip * lanes <= num_rows; row += kStrip * lanes) {
    for (std::size_t j = 0; j < width; ++j) {
      double* const column = x + j * stride + row;
      Vec value[kStrip];
      for (std::size_t s = 0; s < kStrip; ++s) value[s] = hn::LoadU(d, column + s * lanes);
      for (std::size_t p = 0; p < j; ++p) {
        const Vec factor = hn::Set(d, l[p * stride + j]);
        const double* const solved = x + p * stride + row;
        for (std::size_t s = 0; s < kStrip; ++s) {
          value[s] = hn::Sub(value[s], hn::Mul(factor, hn::LoadU(d, solved + s * lanes)));
        }
      }
      const Vec pivot = hn::Set(d, l[j * stride + j]);
      for (std::size_t s = 0; s < kStrip; ++s) hn::StoreU(hn::Div(value[s], pivot), d, column + s * lanes);
    }
  }
  for (; row < num_rows; ++row) {
    for (std::size_t j = 0; j < width; ++j) {
      double value = x[j * stride + row];
      for (std::size_t p = 0; p < j; ++p) value -= l[p * stride + j] * x[p * stride + row];
      x[j * stride + row] = value / l[j * stride + j];
    }
  }
}

}  // namespace taut::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace taut::detail {

namespace {

constexpr Index kPanel = 128;
constexpr Index kRowsPerTask = 256;  // a multiple of every tile height

/// Factors a small block, column by column. Returns the number of good pivots.
Index factor_block(double* a, Index n, Index stride) {
  for (Index j = 0; j < n; ++j) {
    double* const column = a + j * stride;
    for (Index p = 0; p < j; ++p) {
      const double* const earlier = a + p * stride;
      const double factor = earlier[j];
      for (Index i = j; i < n; ++i) column[i] -= earlier[i] * factor;
    }
    if (!(column[j] > 0)) return j;
    const double pivot = std::sqrt(column[j]);
    column[j] = pivot;
    for (Index i = j + 1; i < n; ++i) column[i] /= pivot;
  }
  return n;
}

/// Rows [first, last) of the n x depth matrix `p` into strips of `height` rows.
void pack(const double* p, Index stride, Index depth, Index first, Index last, Index height, double* out) {
  for (Index strip = first; strip < last; strip += height) {
    double* to = out + strip * depth;
    const Index rows = std::min(height, last - strip);
    for (Index k = 0; k < depth; ++k, to += height) {
      std::copy_n(p + k * stride + strip, rows, to);
      std::fill(to + rows, to + height, 0.0);
    }
  }
}

}  // namespace

Index cholesky_in_place(double* a, Index n, Index stride, const Context& context) {
  const Index tile_height = static_cast<Index>(TAUT_DISPATCH(tile_rows)());
  const Index tile_width = static_cast<Index>(TAUT_DISPATCH(tile_columns)());
  const auto room = [&](Index height) { return static_cast<std::size_t>((n + height) * kPanel); };
  std::vector<double> packed_rows(room(tile_height));
  std::vector<double> packed_columns(room(tile_width));
  for (Index start = 0; start < n; start += kPanel) {
    const Index width = std::min(kPanel, n - start);
    double* const diagonal = a + start * stride + start;
    const Index good = factor_block(diagonal, width, stride);
    if (good < width) return start + good;
    const Index below = n - start - width;
    if (below == 0) break;
    double* const panel = diagonal + width;
    double* const rest = panel + width * stride;
    detail::parallel_for(context, 0, below, kRowsPerTask, [&](Index first, Index last) {
      TAUT_DISPATCH(solve_rows)
      (diagonal, static_cast<std::size_t>(width), static_cast<std::size_t>(stride), panel + first,
       static_cast<std::size_t>(last - first));
      pack(panel, stride, width, first, last, tile_height, packed_rows.data());
    });
    pack(panel, stride, width, 0, below, tile_width, packed_columns.data());
    detail::parallel_for(context, 0, below, kRowsPerTask, [&](Index first, Index last) {
      TAUT_DISPATCH(update_rows)
      (packed_rows.data(), packed_columns.data(), static_cast<std::size_t>(width), static_cast<std::size_t>(first),
       static_cast<std::size_t>(last), rest, static_cast<std::size_t>(stride));
    });
    const double left = static_cast<double>(below) / static_cast<double>(n);
    context.report("fit", 1 - left * left * left);
  }
  return n;
}

void cholesky_solve(const double* l, Index n, Index stride, double* b) {
  for (Index j = 0; j < n; ++j) {
    const double* const column = l + j * stride;
    b[j] /= column[j];
    for (Index i = j + 1; i < n; ++i) b[i] -= column[i] * b[j];
  }
  for (Index j = n - 1; j >= 0; --j) {
    const double* const column = l + j * stride;
    double value = b[j];
    for (Index i = j + 1; i < n; ++i) value -= column[i] * b[i];
    b[j] = value / column[j];
  }
}

}  // namespace taut::detail
#endif
