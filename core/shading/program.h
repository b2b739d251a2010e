// Materials compiled: constants in a table, and a program of nodes for what varies over a surface.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/items.h"
#include "shading/batch.h"
#include "textures/texture_set.h"

namespace trp {

struct Snapshot;
struct PlacedSurface;

// The coefficients as rows of one table; an RGB takes three.
enum CoefficientRow {
    kEmission = 0,
    kAmbient = 3,
    kDiffuse = 6,
    kSpecular = 9,
    kShininess = 12,
    kAlpha = 13,
    kMirror = 14,
    kTransmission = 17,
    kIor = 20,
    kCoefficientRows = 21
};

// A material made ready: its constants, and the instructions for the rest.
struct CompiledMaterial {
    struct Instruction {
        int32_t type = 0;
        std::array<int32_t, TRP_NODE_INPUTS> inputs{};  // registers, or TRP_NO_NODE
        std::array<std::array<float, 4>, TRP_NODE_INPUTS> values{};
        std::shared_ptr<const OpenTexture> texture;
        std::string name;
    };
    // coefficient row … row + 2 (or row alone) *= register
    struct Output {
        int row, channels, node;
    };

    std::string name;
    std::array<float, kCoefficientRows> constants{};
    std::vector<Instruction> instructions;
    std::vector<Output> outputs;
    int32_t normal = TRP_NO_NODE;
    int32_t index = 0;
    bool thin = false, double_sided = true, fresnel = false;
    int32_t priority = 0;
    Vec3 absorption{0, 0, 0};
    bool emits = false;      // its emission is not 0
    bool has_holes = false;  // alpha may be below 1
    bool transmits = false;  // its transmission is not 0
    bool mirrors = false;    // its mirror coefficient is not 0

    bool has_program() const { return !instructions.empty(); }
    // Rays are refracted into it, and are in it until they leave.
    bool is_solid() const { return transmits && !thin; }
    bool needs_footprint() const;
};

// Folds constant nodes and leaves out nodes that nothing reads.
CompiledMaterial compile(const Material& material, const TextureSet& textures);

// What runs a program: registers of a batch. One to a thread.
class ProgramScratch {
  public:
    struct Register {
        alignas(64) Lanes value[4];
        alignas(64) Lanes ddx[2], ddy[2];  // of u and v, by one pixel
    };
    Register* registers(size_t count) {
        if (registers_.size() < count) registers_.resize(count);
        return registers_.data();
    }

  private:
    std::vector<Register> registers_;
};

// Texture coordinates of the lanes listed, packed, with their derivatives by one pixel; 0 where the mesh has no such
// set.
void read_uv(const Snapshot& snapshot, const std::string& uv_set, const Points& points, const int32_t* lanes, int count,
             ProgramScratch::Register& out);

// Texture coordinates of a lane in the first UV set of its mesh; 0 where it has none.
Vec2 first_uv(const PlacedSurface& surface, const Points& points, int lane);

// Runs the material's program for the lanes listed, multiplies its outputs into `coefficients`, and replaces the
// points' shading normals where it names one. `lanes` holds kBatch numbers, those beyond the count any of the batch's.
void run_program(const Snapshot& snapshot, const CompiledMaterial& material, const int32_t* lanes, int count,
                 Points& points, Coefficients& coefficients, ProgramScratch& scratch);

}  // namespace trp
