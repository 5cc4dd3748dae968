#pragma once

#include <string_view>

namespace taut::paper {

extern const std::string_view kReportStyle;  ///< report.css

}  // namespace taut::paper
