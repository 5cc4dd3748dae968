#pragma once

#include <string_view>

namespace taut {

/// How a computation ended. The request was valid; this is the mathematics' answer.
enum class Status {
  ok,              ///< converged to the tolerance asked for
  not_converged,   ///< the best iterate is returned, its residuals and `length_error` say how good it is
  disconnected,    ///< the two points lie on different components of the surface, or seem to: the message says
                   ///< what is proved
  left_domain,     ///< the curve leaves the surface's domain (past the edge of a scan, or cut off by an inequality)
  rank_deficient,  ///< the curve runs into a point where the Jacobian loses rank
  cancelled,       ///< stopped by the caller
  out_of_time,
  out_of_memory,
};

/// The name used in JSON, CSV and messages: "ok", "not_converged", ...
[[nodiscard]] constexpr std::string_view to_string(Status status) {
  switch (status) {
    case Status::ok: return "ok";
    case Status::not_converged: return "not_converged";
    case Status::disconnected: return "disconnected";
    case Status::left_domain: return "left_domain";
    case Status::rank_deficient: return "rank_deficient";
    case Status::cancelled: return "cancelled";
    case Status::out_of_time: return "out_of_time";
    case Status::out_of_memory: return "out_of_memory";
  }
  return "unknown";
}

}  // namespace taut
