#include "host/images/library_threads.h"

#include <ImfThreading.h>

#include <mutex>

namespace clshade {

void stop_library_threads() {
    // Two callers that replace the pool at once would delete the same one (IlmThreadPool.cpp of 3.1.5, setProvider).
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    if (Imf::globalThreadCount() != 0) {
        Imf::setGlobalThreadCount(0);
    }
}

} // namespace clshade
