// The rasterizer's peer: OpenGL on the processor by Mesa's llvmpipe, off screen.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace trp_bench {

// An indexed triangle mesh with a normal to each vertex; three numbers to each.
struct IndexedMesh {
    std::vector<float> positions, normals;
    std::vector<uint32_t> indices;
};

// A sphere of radius 1 about the origin: a cube's faces of n × n quads, pushed out. 12 n² triangles.
IndexedMesh cube_sphere(uint32_t n);

// What both sides show: a camera that looks from `eye` to the origin, Y up, and two lights of the classic kind, without
// falloff, whose K_D, K_S and n these are.
struct ClassicScene {
    std::array<float, 3> eye{0, 0.6f, 2.4f};
    float vertical_angle = 0.9076f;  // 52°
    float near = 0.1f, far = 20;
    std::array<std::array<float, 3>, 2> light_positions{{{2, 4, 3}, {-3, 1, 2}}};
    std::array<std::array<float, 3>, 2> light_colors{{{0.9f, 0.85f, 0.8f}, {0.2f, 0.25f, 0.35f}}};
    std::array<float, 3> diffuse{0.7f, 0.45f, 0.3f};
    float specular = 0.4f, shininess = 32, ambient = 0.06f;
};

class GlPeer {
  public:
    enum class Drawing { phong, wireframe, hidden_line };

    // Draws with so many threads (0 to 32, LP_NUM_THREADS). Throws where there is no llvmpipe.
    GlPeer(const ClassicScene& scene, uint32_t width, uint32_t height, uint32_t samples, uint32_t threads);
    ~GlPeer();
    GlPeer(const GlPeer&) = delete;
    GlPeer& operator=(const GlPeer&) = delete;

    void set_mesh(const IndexedMesh& mesh);
    // A whole frame; returns when it is done. With Phong's shading in each pixel, back faces left out; or white lines
    // on black, of one pixel and not smoothed, the triangles' edges and with them the diagonals: all of them, or in two
    // passes, back faces left out, over black faces that hide what lies behind.
    void draw(Drawing drawing);
    // RGBA, 8 bits, row 0 at the bottom.
    std::vector<uint8_t> read() const;
    std::string renderer() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace trp_bench
