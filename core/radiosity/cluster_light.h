// What a node of the hierarchy gives to and gets from groups of elements: each root element within a cluster gets light
// by its own place and normal, and gives it by its own area, normal and radiosity, while all that leaves a node comes
// from one point (α-links; Smits, Arvo and Greenberg 1994).
//
// In a direction w the roots that are turned to the other node give Σ B A n · w: a lobe to each colour, exact for all
// directions in which the same roots show themselves. The point is the middle of that power, so that what is left out
// is of second order in the node's radius over its distance.
#pragma once

#include "radiosity/clusters.h"
#include "radiosity/linear.h"

namespace trp {

// Light that leaves a node towards another.
struct NodeLight {
    Vec3 from{0, 0, 0};
    Vec3 lobes[3] = {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};  // W by colour, over π
    float room = 0;  // added to squares of distances, m²: 1/π of what shows itself, so that no more than that arrives
    float mean = 0;  // brightness of its radiosity
};

// By colour and root, in the order of ElementClusters::roots.
struct RootColors {
    std::vector<float> of[3];
    void resize(const ElementClusters& clusters);
    void set(size_t root, const Vec3d& color);
};

// Irradiance that comes to roots, by colour and root, and what it changes by per metre along X, Y and Z.
struct RootLight {
    std::vector<float> mean[3], slope[3][3];
    void clear(const ElementClusters& clusters);
    Linear at(size_t root, const PlaneAxes& axes) const;
};

// Of a cluster, or where there is no radiosity, of one that gives 1 everywhere.
NodeLight light_of(const ElementClusters& clusters, NodeId cluster, const RootColors* radiosity, const Vec3& towards);
NodeLight light_of(const Elements& elements, uint32_t element, const Vec3d& radiosity);

// Adds what arrives at roots `first` to `end`, times the tint. Threads must be sixteen roots apart, in multiples of 16.
void receive(const ElementClusters& clusters, const NodeLight& light, const Vec3& tint, uint32_t first, uint32_t end,
             RootLight& out);
// What arrives at an element.
Linear receive(const Elements& elements, uint32_t element, const NodeLight& light, const PlaneAxes& axes);
// Of the first colour, at a point.
double irradiance_at(const NodeLight& light, const Vec3& point, const Vec3& normal);
// The mean of the first colour's irradiance over a cluster.
float mean_irradiance(const ElementClusters& clusters, NodeId cluster, const NodeLight& light);

}  // namespace trp
