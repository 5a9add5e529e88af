// Stand-in for oneTBB's header, see workers.h.
#pragma once

#include <array>
#include <memory>

#include <tbb/workers.h>

namespace tbb {

/// Each worker has its place from the beginning, so that finding it orders nothing.
template <class T>
class combinable {
public:
    T& local()
    {
        std::unique_ptr<T>& element = elements_[stand_in::worker];
        if (element == nullptr) element = std::make_unique<T>();
        return *element;
    }

    template <class Visit>
    void combine_each(Visit visit)
    {
        for (const std::unique_ptr<T>& element : elements_)
            if (element != nullptr) visit(*element);
    }

private:
    std::array<std::unique_ptr<T>, stand_in::worker_count> elements_;
};

}  // namespace tbb
