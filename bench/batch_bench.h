// Timing whole runs, from files to files, beside the least that must be done and beside a straightforward program.
//
// A row's sequence is written into a folder of TMPDIR that is removed at the end, on a signal too. Contestants: our
// pipeline (device open, kernel built, one distant light, automatic materials), the fastest of the library's ways to
// decode the same channels and encode a picture like ours (batch_library_rival.h), and the OpenImageIO program
// (batch_oiio_rival.h). All write the sequence's own type and compression, in turns, several frames each; every input
// has been read before (it lies in the page cache), and all that others have written is on the disk before a clock
// starts. Our outputs are forced to the disk, as always; the rivals' are not. Before that the program's picture is
// compared with ours, and the library's outputs are read back.
#pragma once

#include "bench/batch_rows.h"
#include "bench/benchmark.h"

#include <functional>
#include <string>
#include <vector>

namespace clshade {

/// What is allowed between the OpenImageIO program's picture and ours, both in float: N.H in its usual form
/// (rival_tolerance) under exponents up to 1250.
inline constexpr double oiio_tolerance = 1e-3;

/// One result per row, in their order; a row that fails has status error and the reason. `tell` is called before each.
[[nodiscard]] std::vector<BenchResult> run_batch_rows(Device& device, const BenchOptions& options,
                                                      const std::vector<BatchRow>& rows,
                                                      const std::function<void(const std::string& what)>& tell);

/// The limits on speed that hold for rows at 1920x1080.
[[nodiscard]] std::vector<SpeedLimit> batch_limits(const std::vector<BenchResult>& results);

} // namespace clshade
