#pragma once

#include <string_view>
#include <vector>

namespace taut {

/// Which of the known names is meant by `name`, which is none of them: the one with the fewest letters to insert, drop,
/// change or swap with their neighbour (letter case counts half). Empty where the nearest is too far to be meant: more
/// than one step for up to four letters, two for longer names. The first of several that are as near.
[[nodiscard]] std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& known);

}  // namespace taut
