// Folders that do not outlive a failure.
#pragma once

#include <filesystem>
#include <vector>

namespace fastccd::tools {

/// A folder for output. Those of it and of the folders above it that were missing are created, and removed again at the end if
/// nothing came into them.
class NewFolder {
public:
    /// Throws InputError when it cannot be created, or is no folder.
    explicit NewFolder(const std::filesystem::path& path);
    ~NewFolder();

    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;

private:
    void remove_empty() const;

    std::vector<std::filesystem::path> created_;  // outermost first
};

}  // namespace fastccd::tools
