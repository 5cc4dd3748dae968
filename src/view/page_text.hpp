#pragma once

#include <string_view>

namespace taut::detail {

// The page's source files, embedded at build time from src/view/page.
extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;

}  // namespace taut::detail
