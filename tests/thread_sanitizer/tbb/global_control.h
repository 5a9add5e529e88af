// Stand-in for oneTBB's header, see workers.h.
#pragma once

#include "workers.h"

namespace tbb {

struct global_control {
    enum parameter { max_allowed_parallelism };

    static std::size_t active_value(parameter) { return stand_in::worker_count; }
};

}  // namespace tbb
