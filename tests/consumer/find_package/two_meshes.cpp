#include <cstdio>
#include <fastccd/fastccd.hpp>
using namespace fastccd;

int main()
{
    // A tetrahedron (vertices 0 to 3) falls onto a triangle (4 to 6): positions at both ends of the step, faces, edges.
    const double start[][3] = {{0, 0, 1}, {3, 0, 2}, {-2, 2, 2}, {-2, -2, 2}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    const double end[][3] = {{0, 0, -0.8}, {3, 0, 0.2}, {-2, 2, 0.2}, {-2, -2, 0.2}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    const int faces[][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}, {4, 5, 6}};
    const int edges[][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}, {3, 1}, {4, 5}, {5, 6}, {6, 4}};
    const MovingMesh mesh{PositionView::rows(start[0], 7), PositionView::rows(end[0], 7),
                          IndexView::rows(faces[0], 5, 3), IndexView::rows(edges[0], 9, 2)};
    // Candidates: here all pairs of the two meshes; for large ones, what your broad phase finds.
    std::vector<VertexFace> vf{{0, 4}, {1, 4}, {2, 4}, {3, 4}};
    for (int i = 0; i < 12; ++i) vf.push_back({4 + i / 4, i % 4});
    std::vector<EdgeEdge> ee;
    for (int i = 0; i < 18; ++i) ee.push_back({i / 3, 6 + i % 3});

    std::vector<Contact> contacts;  // pair, toi, and whether it is proven
    Status status = find_contacts(mesh, vf, Options{}, contacts);
    for (const Contact& c : contacts) std::printf("vertex %d meets face %d at %.6f\n", vf[c.pair].vertex, vf[c.pair].face, c.toi);
    contacts.clear();
    if (status.ok()) status = find_contacts(mesh, ee, Options{}, contacts);
    for (const Contact& c : contacts) std::printf("edge %d meets edge %d at %.6f\n", ee[c.pair].edge_a, ee[c.pair].edge_b, c.toi);
    if (!status.ok()) std::puts(message(status.error));
}
