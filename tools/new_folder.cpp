#include "new_folder.hpp"

#include <algorithm>
#include <string>
#include <system_error>

#include "input_error.hpp"

namespace fastccd::tools {

namespace fs = std::filesystem;

NewFolder::NewFolder(const fs::path& folder)
{
    std::error_code error;
    std::vector<fs::path> missing;
    for (fs::path path = folder; !path.empty() && !fs::exists(path, error); path = path.parent_path()) {
        if (path.has_filename()) missing.push_back(path);
    }
    std::reverse(missing.begin(), missing.end());
    for (const fs::path& path : missing) {
        if (fs::create_directory(path, error)) created_.push_back(path);
        if (!error) continue;
        const std::string reason = error.message();
        remove_empty();
        throw InputError(folder, "cannot be created: " + reason);
    }
    if (fs::is_directory(folder, error)) return;
    remove_empty();
    throw InputError(folder, "is no folder");
}

NewFolder::~NewFolder()
{
    remove_empty();
}

void NewFolder::remove_empty() const
{
    std::error_code not_empty;
    for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder) fs::remove(*folder, not_empty);
}

}  // namespace fastccd::tools
