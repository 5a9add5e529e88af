// Pairs of ordinary coordinates that stay farther than d, at which the search with a separation has to let directions follow the primitives
// (scalar/following_direction.hpp): without that, hill climbing drove it beyond 4,096 looks and to contact, the face at 13 d.
#pragma once

#include "oracle/pair.hpp"

namespace fastccd::testing {

struct FollowedPair {
    oracle::Kind kind;
    double distance;
    oracle::Pair pair;
};

inline const FollowedPair followed_pairs[] = {
    {oracle::Kind::edge_edge, 0x1.5798ee2308c3ap-27,
     {{{0x1.2973d3e62287fp+0, 0x1.e07de3737894bp-2, 0x1.7418f2e69c57dp+0},
       {0x1.91a2608a24514p-1, -0x1.6919ffdc23c2ap-1, -0x1.ecc48963927fp-2},
       {0x1.98e62fbaa0984p-1, -0x1.527f151c40ap-1, -0x1.a24b7006f517cp-2},
       {-0x1.9ba88d9e95adp-4, -0x1.9eaf2025e810cp-4, -0x1.1bbcab1f24aafp-2},
       {0x1.507ece0c183f4p-2, -0x1.9b7aa64110b64p-4, 0x1.9bc7eeee185adp-2},
       {0x1.73d68e2386dd9p+0, -0x1.70f499295c2dcp-2, -0x1.20a6e5880e9d8p+0},
       {0x1.6905d5e827a16p+0, -0x1.66f3eabac80cdp-2, -0x1.11ee6da8d9214p+0},
       {-0x1.b428b37463d54p-1, 0x1.198d71e50b029p-2, -0x1.85ae22d7a12f8p-1}}}},
    {oracle::Kind::vertex_face, 0x1.50a5f2c364698p-15,
     {{{-0x1.f7a90cfb68d97p-3, 0x1.00004212c5239p-2, -0x1.ea7c290378e7ap-3},
       {0x1.6bd3a79577a02p+2, -0x1.7e8dc87e63a3fp-22, 0x1.ad82a60112d8dp-3},
       {0x1.6b3964ca8adcp-1, 0x1.00006702423b6p-1, -0x1.3330372c679fbp-1},
       {-0x1.07d1367e9a72dp-2, 0x1.00007460656b1p-2, -0x1.ea904bd486138p-3},
       {-0x1.59c9f018a0003p-4, 0x1.ee7943098b29cp-3, 0x1.f8169be8ca9d5p-3},
       {0x1.85d2b789a5a27p+2, -0x1.3365e89b0663bp-26, 0x1.bc54b7578204ep-2},
       {0x1.6c549030ae7ddp+2, 0x1.903774f8bfd09p-5, -0x1.0bae2f1b51e12p+5},
       {-0x1.afcc7ccde7e39p-2, 0x1.05652b52e42d7p-2, 0x1.28b219fc32284p-2}}}},
};

}  // namespace fastccd::testing
