// What contacts do from one part of a scene to another: C, which is nothing but at the few points that they couple.
#pragma once

#include "ringlet/contact/contact_set.h"
#include "ringlet/solver/scene_vertices.h"

#include <vector>

namespace ringlet {

class Couplings {
public:
    // Goes over to those of these contacts that are between two parts. `unit_of` says of each part which of the units it is in.
    void find(const ContactSet &contacts, const SceneVertices &vertices, View<int> unit_of, int units);

    bool couples(int part) const { return together_[part]; }
    // Parts that touch one another, directly or by others: of each part the first of those that it is so joined with.
    const std::vector<int> &clusters() const { return clusters_; }

    // Points are vertices that are coupled, numbered unit by unit.
    int count() const { return int(points_.items().size()); }
    int begin(int unit) const { return points_.begin(unit); }
    int end(int unit) const { return points_.end(unit); }
    int vertex(int point) const { return points_.items()[point].vertex; }
    int part(int point) const { return points_.items()[point].part; }

    // C p, and p · C p, which is added to that of each cluster; of parts that are busy. p says where each point goes.
    void push(View<Vec3> p, View<ContactValue> values, View<unsigned char> busy, std::vector<double> &of_clusters);
    Vec3 pushed(int point) const; // C p there

private:
    struct Coupling {
        int contact, first;       // how many of the four are on its first side
        std::array<int, 2> parts; // of the two sides
        std::array<int, 4> point; // −1: held
        std::array<double, 4> weight;
        std::array<Vec3, 2> pushes; // on the two sides
    };
    void join_parts(int parts);
    void number_points(const SceneVertices &vertices, const ContactSet &contacts, View<int> unit_of, int units);

    std::vector<Coupling> couplings_;
    std::vector<unsigned char> together_; // per part
    std::vector<int> clusters_;
    struct Point {
        int vertex, part;
    };
    Lists<Point> points_; // of units
    struct Role {
        int coupling, as;
    };
    Lists<Role> roles_; // of points
};

} // namespace ringlet
