// The contacts of a scene as CSV.
#pragma once

#include <cstddef>
#include <filesystem>

#include <fastccd/options.hpp>

#include "../row_file.hpp"
#include "pair_vertices.hpp"

namespace fastccd::tools {

/// Columns `step,kind,v0,v1,v2,v3,toi`: kind vf or ee, vertex indices as pair_vertices gives them, toi in 17
/// significant digits, which read back to the same double. Appears on commit(): see OutputFile, also for
/// the meaning of "-". With `proof` another column, `proven`: 1 or 0.
class SceneHits {
public:
    /// Throws InputError.
    SceneHits(const std::filesystem::path& path, bool proof);

    /// Appends a contact. Throws as OutputFile::write.
    void append(std::size_t step, PairKind kind, const PairVertices& vertices, const Contact& contact);

    /// Throws as OutputFile::write and OutputFile::commit.
    void commit() { rows_.commit(); }

private:
    RowFile rows_;
    bool proof_;
};

}  // namespace fastccd::tools
