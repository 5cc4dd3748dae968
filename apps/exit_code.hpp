#pragma once

#include "taut/core/status.hpp"

namespace taut::app {

/// The program's exit codes: a contract with scripts, see docs/command_line.md.
enum ExitCode : int {
  kDone = 0,
  kSomeLinesFailed = 1,
  kWrongUsage = 2,
  kBadInput = 3,
  kNoPath = 4,
  kNotConverged = 5,
  kInternalError = 70,
  kInterrupted = 130,
};

/// The status of a line of a batch that asks for nothing that can be answered; it stands in the place of a Status.
inline constexpr const char* kBadInputStatus = "bad_input";

[[nodiscard]] constexpr ExitCode exit_code(Status status) {
  switch (status) {
    case Status::ok: return kDone;
    case Status::disconnected: return kNoPath;
    case Status::cancelled: return kInterrupted;
    case Status::out_of_memory: return kBadInput;
    case Status::not_converged:
    case Status::left_domain:
    case Status::rank_deficient:
    case Status::out_of_time: return kNotConverged;
  }
  return kInternalError;
}

}  // namespace taut::app
