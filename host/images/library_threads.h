// Private to host/images: OpenEXR's own threads.
#pragma once

namespace clshade {

/// Stops OpenEXR's own threads if somebody (OpenImageIO does) started them: its work is spread by oneTBB here, and a
/// thread that waits for a pool is a thread wasted. Any number of threads may call this at a time, which
/// Imf::setGlobalThreadCount itself does not allow.
void stop_library_threads();

} // namespace clshade
