// Narrow phases of other libraries, as they come in Debian's packages.
//
// A peer gets pairs in its own structures, prepared outside of the measured time.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <fastccd/options.hpp>

namespace fastccd::peers {

class Peer {
public:
    virtual ~Peer() = default;
    /// Converts `count` pairs of 24 coordinates each, in the order of PairView; replaces earlier ones.
    virtual void prepare(const double* pairs, std::size_t count) = 0;
    /// Sets toi[i] of prepared pair i: the time of contact that the peer finds, NaN if it finds contact but gives no time,
    /// +infinity if it finds none.
    virtual void run(double* toi) = 0;
};

struct NamedPeer {
    std::string name;
    PairKind kind;
    std::unique_ptr<Peer> (*make)();
};

/// FCL's cubic test (Intersect::intersect_VF and intersect_EE) with its Newton and its closed-form solver; empty if built
/// without FCL.
[[nodiscard]] std::vector<NamedPeer> fcl_peers();
/// Bullet's Bernstein vertex-face test of deformable bodies (bernsteinCCD), which gives no time; it has none for edges. Empty
/// if built without Bullet.
[[nodiscard]] std::vector<NamedPeer> bullet_peers();

}  // namespace fastccd::peers
