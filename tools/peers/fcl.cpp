#include "peers.hpp"

#if defined(FASTCCD_HAVE_FCL)
#include <array>
#include <limits>

#include <fcl/narrowphase/detail/traversal/collision/intersect.h>
#endif

namespace fastccd::peers {

#if defined(FASTCCD_HAVE_FCL)

namespace {

using Point = fcl::Vector3<double>;
using Test = fcl::detail::Intersect<double>;

/// FCL takes the face before the vertex; edges are in our order.
template <PairKind kind>
constexpr std::array<std::size_t, 4> point_order =
    kind == PairKind::vertex_face ? std::array<std::size_t, 4>{1, 2, 3, 0} : std::array<std::size_t, 4>{0, 1, 2, 3};

template <PairKind kind, bool newton>
class FclPeer final : public Peer {
public:
    void prepare(const double* pairs, std::size_t count) override
    {
        pairs_.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < 8; ++k) {
                const double* const x = pairs + 24 * i + 12 * (k / 4) + 3 * point_order<kind>[k % 4];
                pairs_[i][k] = Point(x[0], x[1], x[2]);
            }
    }

    void run(double* toi) override
    {
        double time = 0;
        Point where = Point::Zero();
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            const auto& p = pairs_[i];
            bool touches = false;
            if constexpr (kind == PairKind::vertex_face)
                touches = Test::intersect_VF(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], &time, &where, newton);
            else
                touches = Test::intersect_EE(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], &time, &where, newton);
            toi[i] = touches ? time : std::numeric_limits<double>::infinity();
        }
    }

private:
    std::vector<std::array<Point, 8>> pairs_;
};

template <PairKind kind, bool newton>
std::unique_ptr<Peer> make()
{
    return std::make_unique<FclPeer<kind, newton>>();
}

}  // namespace

std::vector<NamedPeer> fcl_peers()
{
    constexpr PairKind vf = PairKind::vertex_face, ee = PairKind::edge_edge;
    return {{"fcl-cubic", vf, make<vf, false>},
            {"fcl-newton", vf, make<vf, true>},
            {"fcl-cubic", ee, make<ee, false>},
            {"fcl-newton", ee, make<ee, true>}};
}

#else

std::vector<NamedPeer> fcl_peers() { return {}; }

#endif

}  // namespace fastccd::peers
