// Couplings between the objects of a scene: C, what contacts do from one of their sides to the other. It is zero but at the few
// vertices that they couple.
#pragma once

#include "ringlet/contact/contact_set.h"
#include "ringlet/solver/block_set.h"

#include <vector>

namespace ringlet {

class Couplings {
public:
    // Takes the pairs between two active objects.
    void find(const ContactSet &contacts, const VertexTable &table, const BlockSet &blocks);

    bool couples(int object) const { return coupled_[object]; }
    // Of each object the first of its cluster: those that contacts join, directly or by others.
    const std::vector<int> &clusters() const { return clusters_; }

    // Points, numbered block by block: the coupled vertices of a block whose factor is exact, and all vertices of another.
    int count() const { return int(points_.items().size()); }
    int begin(int block) const { return points_.begin(block); }
    int end(int block) const { return points_.end(block); }
    std::array<int, 2> of_object(int object) const { return range_[object]; } // its first, and their end
    int vertex(int point) const { return points_.items()[point].vertex; }
    int object(int point) const { return points_.items()[point].object; }

    // Computes C p, p being given at the points, for busy objects.
    void multiply(View<Vec3> p, View<PairValue> values, View<unsigned char> busy);
    Vec3 product(int point) const { // C p there
        Vec3 product = Vec3::Zero();
        for (const auto &[coupling, as] : roles_.of(point)) {
            const Coupling &c = couplings_[coupling];
            product += c.weight[as] * c.products[as >= c.first];
        }
        return product;
    }

    struct Coupling {
        int pair, first;            // vertices of the first side
        std::array<int, 2> objects; // of the two sides
        std::array<int, 4> point;   // −1: prescribed, or of no weight
        std::array<double, 4> weight;
        std::array<Vec3, 2> products; // on the two sides
    };
    const std::vector<Coupling> &all() const { return couplings_; } // in the order of pairs

    // The couplings of a point, and as which of their four.
    struct Role {
        int coupling, as;
    };
    View<Role> roles(int point) const { return roles_.of(point); }

private:
    void join_clusters(int objects);
    void number_points(const ContactSet &contacts, const VertexTable &table, const BlockSet &blocks);

    std::vector<Coupling> couplings_;
    std::vector<unsigned char> coupled_; // per object
    std::vector<int> clusters_;
    struct Point {
        int vertex, object;
    };
    Lists<Point> points_;                   // of blocks, by their vertices
    std::vector<std::array<int, 2>> range_; // of objects
    Lists<Role> roles_;                     // of points
};

} // namespace ringlet
