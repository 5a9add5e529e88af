#include "peers.hpp"

#if defined(FASTCCD_HAVE_BULLET)
#include <limits>

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyInternals.h>
#endif

namespace fastccd::peers {

#if defined(FASTCCD_HAVE_BULLET)

namespace {

/// What the test reads of a pair's face and nodes. Positions at the ends of the step are m_x and m_q, dt is 1.
struct BulletPair {
    btSoftBody::Node vertex;
    btSoftBody::Node corners[3];
    btSoftBody::Face face;
};

class BulletPeer final : public Peer {
public:
    void prepare(const double* pairs, std::size_t count) override
    {
        if (pairs_.size() != count) pairs_ = std::vector<BulletPair>(count);
        for (std::size_t i = 0; i < count; ++i) {
            BulletPair& pair = pairs_[i];
            btSoftBody::Node* const nodes[4] = {&pair.vertex, &pair.corners[0], &pair.corners[1], &pair.corners[2]};
            for (std::size_t k = 0; k < 4; ++k) {
                const double* const start = pairs + 24 * i + 3 * k;
                const double* const end = start + 12;
                nodes[k]->m_x = btVector3(start[0], start[1], start[2]);
                nodes[k]->m_q = btVector3(end[0], end[1], end[2]);
                nodes[k]->m_v = nodes[k]->m_q - nodes[k]->m_x;
            }
            // As btSoftBody keeps them per face, so that they cost the test nothing.
            const btSoftBody::Node *a = nodes[1], *b = nodes[2], *c = nodes[3];
            for (int k = 0; k < 3; ++k) pair.face.m_n[k] = nodes[k + 1];
            pair.face.m_n0 = (b->m_x - a->m_x).cross(c->m_x - a->m_x);
            pair.face.m_n1 = (b->m_q - a->m_q).cross(c->m_q - a->m_q);
            pair.face.m_vn = (b->m_v - a->m_v).cross(c->m_v - a->m_v);
        }
    }

    void run(double* toi) override
    {
        btVector3 barycentric;
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            toi[i] = bernsteinCCD(&pairs_[i].face, &pairs_[i].vertex, 1.0, SAFE_EPSILON, barycentric)
                         ? std::numeric_limits<double>::quiet_NaN()
                         : std::numeric_limits<double>::infinity();
    }

private:
    std::vector<BulletPair> pairs_;
};

}  // namespace

std::vector<NamedPeer> bullet_peers()
{
    return {{"bullet-bernstein", PairKind::vertex_face,
             []() -> std::unique_ptr<Peer> { return std::make_unique<BulletPeer>(); }}};
}

#else

std::vector<NamedPeer> bullet_peers() { return {}; }

#endif

}  // namespace fastccd::peers
