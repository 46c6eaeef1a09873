// Rows of a picture in parallel.
#pragma once

#include <functional>

namespace clshade::reference {

/// Calls shade_row(0) to shade_row(height - 1) on at most `threads` threads (no more than the machine has cores), in
/// any order. The calls must not write to the same memory. Exceptions come out.
void for_each_row(int height, int threads, const std::function<void(int)>& shade_row);

} // namespace clshade::reference
