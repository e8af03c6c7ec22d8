// Swept boxes of the primitives of a mesh.
#include "collision_scene.h"
#include "ringlet/collision/swept_boxes.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

bool contains(const SweptBox &box, double t, const Vec3 &x, double radius) {
    const Eigen::Array3d low = (1.0 - t) * box.low.head<3>().cast<double>() + t * box.end_low.head<3>().cast<double>();
    const Eigen::Array3d high = (1.0 - t) * box.high.head<3>().cast<double>() + t * box.end_high.head<3>().cast<double>();
    return (x.array() - radius >= low - 1e-9).all() && (x.array() + radius <= high + 1e-9).all();
}

} // namespace

BOOST_AUTO_TEST_SUITE(swept_boxes)

BOOST_AUTO_TEST_CASE(a_box_contains_its_edge_on_straight_and_curved_paths) {
    CollisionScene scene(1, 0.2);
    std::vector<Vec3> apex = scene.end;
    for (Vec3 &x : apex) x += scene.anywhere(0.1);
    SweptBoxes boxes(scene.mesh);
    const Vec3 origin = scene.start[0];
    boxes.fit({scene.start, scene.end, apex}, {origin, origin});
    for (int i = 0; i < int(scene.mesh.edges.size()); i += 7)
        for (const int v : scene.mesh.edges[i])
            for (const double t : {0.0, 0.3, 1.0})
                for (const double curved : {0.0, 0.5, 1.0}) {
                    const Vec3 end = (1.0 - curved) * scene.end[v] + curved * apex[v];
                    const Vec3 x = scene.start[v] + t * (end - scene.start[v]) - origin;
                    BOOST_TEST(contains(boxes.of_edge(i), t, x, mean_radius(scene.mesh, scene.mesh.edges[i])));
                }
}

BOOST_AUTO_TEST_CASE(a_refit_of_some_vertices_gives_the_boxes_of_a_fit_of_all) {
    CollisionScene scene(2, 0.2);
    SweptBoxes refitted(scene.mesh);
    refitted.fit({scene.start, scene.end}, {scene.start[0], scene.end[0]});
    const std::vector<int> some = {3, 80, 200};
    for (const int v : some) scene.end[v] = 0.5 * (scene.start[v] + scene.end[v]);
    refitted.refit({scene.start, scene.end}, some);
    const SweptBoxes fitted = boxes_of_move(scene.mesh, scene.start, scene.end, 0.0);
    for (int t = 0; t < int(scene.mesh.triangles.size()); ++t)
        BOOST_TEST((refitted.of_triangle(t).end_high - fitted.of_triangle(t).end_high).head<3>().abs().maxCoeff() < 1e-6f);
}

BOOST_AUTO_TEST_SUITE_END()
