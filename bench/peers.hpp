// Narrow phases of other libraries, as they come in Debian's packages.
//
// A peer gets pairs in its own structures, prepared outside of the measured time.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <fastccd/options.hpp>

namespace fastccd::bench {

class Peer {
public:
    virtual ~Peer() = default;
    /// Converts `count` pairs of 24 coordinates each, in the order of PairView; replaces earlier ones.
    virtual void prepare(const double* pairs, std::size_t count) = 0;
    /// Sets touches[i] to whether the peer finds contact in prepared pair i.
    virtual void run(bool* touches) = 0;
};

struct NamedPeer {
    std::string name;
    PairKind kind;
    std::unique_ptr<Peer> (*make)();
};

/// FCL's cubic test (Intersect::intersect_VF and intersect_EE) with its Newton and its closed-form solver; empty if built
/// without FCL.
[[nodiscard]] std::vector<NamedPeer> fcl_peers();
/// Bullet's Bernstein vertex-face test of deformable bodies (bernsteinCCD); it has none for edges. Empty if built without
/// Bullet.
[[nodiscard]] std::vector<NamedPeer> bullet_peers();

}  // namespace fastccd::bench
