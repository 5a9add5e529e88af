// A step as the library takes it.
#pragma once

#include <fastccd/indexed.hpp>

#include "../narrow_phase_run.hpp"
#include "broad_phase.hpp"

namespace fastccd::tools {

/// Throws as throw_unless_ok.
[[nodiscard]] inline MovingMesh moving_mesh(const Step& step)
{
    MovingMesh mesh{PositionView::rows(step.positions0.data(), step.positions0.size() / 3),
                    PositionView::rows(step.positions1.data(), step.positions1.size() / 3),
                    IndexView::rows(step.faces.data(), step.faces.size() / 3, 3),
                    IndexView::rows(step.edges.empty() ? nullptr : step.edges[0].data(), step.edges.size(), 2)};
    throw_unless_ok(mesh.status());
    return mesh;
}

}  // namespace fastccd::tools
