// A crowd of strands whose motions have impacts, limited and resolved.
#pragma once

#include "random.h"
#include "ringlet/ccd/advected_move.h"
#include "ringlet/ccd/limit_move.h"

namespace ringlet {

// Strands at random places that are to move to random others.
struct Crowd {
    CollisionMesh mesh;
    std::vector<Vec3> start, end;
    std::vector<double> mass;

    Crowd(int strands, double size, double motion, unsigned seed, int vertices = 3) {
        Random random{std::mt19937(seed)};
        for (int s = 0; s < strands; ++s) {
            const Vec3 place = random.vector(size), along = random.vector(size), shared = random.vector(motion);
            for (int k = 0; k < vertices; ++k) {
                const int v = int(start.size());
                start.push_back(place + k * along);
                end.push_back(start.back() + shared + random.vector(0.3 * motion));
                mesh.points.push_back(v);
                mesh.radius.push_back(1e-3);
                mesh.moves.push_back(1);
                mesh.object.push_back(s);
                mesh.anchor.push_back(-1);
                mass.push_back(random(0.5, 2.0));
                if (k > 0) mesh.edges.push_back({v - 1, v});
            }
            mesh.objects.push_back({int(start.size()) - vertices, int(start.size()), true});
        }
        mesh.rest = start;
    }

    // Candidate pairs of a move. Paths longer than `max_path` escape their bounds [m].
    struct Found {
        Candidates candidates;
        MoveCandidates pairs;

        Found(const CollisionMesh &mesh, const Move &move, double max_path = 0.0) : candidates(mesh), pairs(candidates) {
            candidates.enclose(move, {.margin = 0.005, .max_path = max_path});
            pairs.begin(move);
        }
    };

    CcdReport limit(std::vector<Vec3> &limited, Yield yield = Yield::near_impacts, double max_path = 0.0) const {
        Found found(mesh, {start, end}, max_path);
        PlannedMove move{end, {}};
        const CcdReport report = limit_move(found.pairs, start, move, yield);
        limited = move.to;
        return report;
    }

    CcdReport resolve(std::vector<Vec3> &resolved) const {
        Found found(mesh, {start, start});
        resolved = end;
        AdvectedMove move(found.pairs, start, resolved);
        resolve_impact_zones({View<double>(mass), [](int, const Vec3 &point) { return point; }}, move);
        truncate_locally(move);
        return move.report();
    }

    // Limits a move; then every third strand is shortened further, and the rest of the move is limited again.
    CcdReport limit_and_shorten(std::vector<Vec3> &limited, Yield yield) const {
        Found found(mesh, {start, end}, 0.1);
        PlannedMove move{end, {}};
        limit_move(found.pairs, start, move, yield);
        std::vector<unsigned char> changed(start.size(), 0);
        for (size_t v = 0; v < start.size(); ++v)
            if (mesh.object[v] % 3 == 0) {
                changed[v] = 1;
                move.to[v] = start[v] + 0.3 * (move.to[v] - start[v]);
            }
        found.pairs.update({start, move.to}, changed);
        const CcdReport report = limit_move(found.pairs, start, move, Yield::as_a_whole);
        limited = move.to;
        return report;
    }

    // The largest distance of a vertex from where one fraction of its strand's move leads it [m].
    double change_of_shape(const std::vector<Vec3> &to) const {
        double most = 0.0;
        for (const auto &[first, last, whole] : mesh.objects) {
            double made = 0.0, wanted = 0.0;
            for (int v = first; v < last; ++v) made += (to[v] - start[v]).norm(), wanted += (end[v] - start[v]).norm();
            for (int v = first; v < last; ++v)
                most = std::max(most, (to[v] - start[v] - made / wanted * (end[v] - start[v])).norm());
        }
        return most;
    }

    // Whether any pair has an impact, asked of pairs that are found for this move alone.
    bool has_impacts(const std::vector<Vec3> &to) const {
        const Found found(mesh, {start, to}, 1.0);
        return !find_impacts(mesh, found.pairs.impact_candidates(), start, to).empty();
    }

    // The least distance of any two strands on the move, from dense samples [m].
    double closest(const std::vector<Vec3> &to) const {
        double least = 1.0;
        std::vector<Vec3> now(start.size());
        for (int step = 0; step <= 400; ++step) {
            for (size_t v = 0; v < start.size(); ++v) now[v] = start[v] + (step / 400.0) * (to[v] - start[v]);
            for (size_t a = 0; a < mesh.edges.size(); ++a)
                for (size_t b = 0; b < a; ++b)
                    if (!share_vertex(mesh.edges[a], mesh.edges[b]))
                        least = std::min(least, std::sqrt(closest_points(now, mesh.edges[a], mesh.edges[b]).distance2));
        }
        return least;
    }

    // The least distance of any pair on the move, relative to its minimum separation.
    double least_separation(const std::vector<Vec3> &to) const {
        double least = 1e9;
        std::vector<Vec3> now(start.size());
        for (int step = 0; step <= 100; ++step) {
            for (size_t v = 0; v < start.size(); ++v) now[v] = start[v] + (step / 100.0) * (to[v] - start[v]);
            for (const auto &a : mesh.edges)
                for (const auto &b : mesh.edges) {
                    if (share_vertex(a, b)) continue;
                    const double first = std::sqrt(closest_points(start, a, b).distance2);
                    const double separation = std::min(0.5 * activation_distance(mesh, a, b), 0.2 * first);
                    least = std::min(least, std::sqrt(closest_points(now, a, b).distance2) / separation);
                }
        }
        return least;
    }
};

} // namespace ringlet
