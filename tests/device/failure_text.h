// What an error says.
#pragma once

#include "host/base/error.h"

#include <string>

namespace clshade::tests {

/// The message of the clshade::Error that `work` throws.
template <class Work>
std::string failure_text(Work&& work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

} // namespace clshade::tests
