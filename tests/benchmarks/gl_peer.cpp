#define GL_GLEXT_PROTOTYPES
#include "gl_peer.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace trp_bench {
namespace {

const char* const kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) uniform mat4 clip_from_world;
out vec3 p, n;
void main() {
    gl_Position = clip_from_world * vec4(position, 1);
    p = position;
    n = normal;
}
)";

const char* const kFragmentShader = R"(#version 450 core
layout(location = 1) uniform vec3 eye;
layout(location = 2) uniform vec3 light_position[2];
layout(location = 4) uniform vec3 light_color[2];
layout(location = 6) uniform vec3 diffuse;
layout(location = 7) uniform vec3 classic;  // K_S, n, I_A
in vec3 p, n;
out vec4 color;
void main() {
    vec3 normal = normalize(n), v = normalize(eye - p), sum = diffuse * classic.z;
    for (int i = 0; i < 2; ++i) {
        vec3 l = normalize(light_position[i] - p);
        float n_dot_l = dot(normal, l);
        if (n_dot_l <= 0) continue;
        vec3 r = 2 * n_dot_l * normal - l;
        sum += light_color[i] * (diffuse * n_dot_l + classic.x * pow(max(dot(r, v), 0), classic.y));
    }
    color = vec4(sum, 1);
}
)";

const char* const kFlatShader = R"(#version 450 core
layout(location = 9) uniform float brightness;
out vec4 color;
void main() { color = vec4(brightness); }
)";

void require(bool true_, const char* what) {
    if (!true_) throw std::runtime_error(std::string("OpenGL: ") + what);
}

GLuint compile(GLenum kind, const char* source) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    require(good, "a shader does not compile");
    return shader;
}

GLuint make_renderbuffer(GLenum attachment, GLenum format, uint32_t width, uint32_t height, uint32_t samples) {
    GLuint buffer = 0;
    glGenRenderbuffers(1, &buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, static_cast<GLsizei>(samples), format,
                                     static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
    return buffer;
}

using Vector = std::array<float, 3>;

Vector unit(const Vector& v) {
    const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
float dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Column by column.
std::array<float, 16> clip_from_world(const ClassicScene& scene, float aspect) {
    const Vector z = unit(scene.eye), x = unit(cross({0, 1, 0}, z)), y = cross(z, x);
    const float scale = 1 / std::tan(scene.vertical_angle / 2), n = scene.near, f = scene.far;
    std::array<float, 16> out{};
    for (size_t c = 0; c < 4; ++c) {
        const auto row = [&](const Vector& axis) { return c < 3 ? axis[c] : -dot(axis, scene.eye); };
        out[4 * c] = scale / aspect * row(x);
        out[4 * c + 1] = scale * row(y);
        out[4 * c + 2] = (f + n) / (n - f) * row(z) + (c == 3 ? 2 * f * n / (n - f) : 0);
        out[4 * c + 3] = -row(z);
    }
    return out;
}

}  // namespace

IndexedMesh cube_sphere(uint32_t n) {
    IndexedMesh mesh;
    for (size_t axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const auto first = static_cast<uint32_t>(mesh.positions.size() / 3);
            for (uint32_t j = 0; j <= n; ++j)
                for (uint32_t i = 0; i <= n; ++i) {
                    Vector p;
                    p[axis] = side;
                    p[(axis + 1) % 3] = 2 * static_cast<float>(i) / static_cast<float>(n) - 1;
                    p[(axis + 2) % 3] = side * (2 * static_cast<float>(j) / static_cast<float>(n) - 1);
                    p = unit(p);
                    mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
                }
            for (uint32_t j = 0; j < n; ++j)
                for (uint32_t i = 0; i < n; ++i) {
                    const uint32_t a = first + j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
                    mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
                }
        }
    mesh.normals = mesh.positions;
    return mesh;
}

struct GlPeer::State {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    uint32_t width, height, samples;
    GLuint drawn = 0, resolved = 0, shaded = 0, flat = 0;
    GLsizei indices = 0;
};

GlPeer::GlPeer(const ClassicScene& scene, uint32_t width, uint32_t height, uint32_t samples, uint32_t threads)
    : state_(std::make_unique<State>()) {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    State& s = *state_;
    s.width = width, s.height = height, s.samples = samples;
    const auto get_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    require(get_display, "EGL has no platform displays");
    s.display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    require(eglInitialize(s.display, nullptr, nullptr), "EGL does not start");
    eglBindAPI(EGL_OPENGL_API);
    const EGLint wanted[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    s.context = eglCreateContext(s.display, nullptr, EGL_NO_CONTEXT, wanted);
    require(s.context && eglMakeCurrent(s.display, EGL_NO_SURFACE, EGL_NO_SURFACE, s.context), "no context");

    const uint32_t several = samples > 1 ? samples : 0;
    if (several) {
        glGenFramebuffers(1, &s.resolved);
        glBindFramebuffer(GL_FRAMEBUFFER, s.resolved);
        make_renderbuffer(GL_COLOR_ATTACHMENT0, GL_RGBA8, width, height, 0);
    }
    glGenFramebuffers(1, &s.drawn);
    glBindFramebuffer(GL_FRAMEBUFFER, s.drawn);
    make_renderbuffer(GL_COLOR_ATTACHMENT0, GL_RGBA8, width, height, several);
    make_renderbuffer(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, width, height, several);
    require(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "no frame buffer");
    glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);

    const auto matrix = clip_from_world(scene, static_cast<float>(width) / static_cast<float>(height));
    const auto link = [&](const char* fragments) {
        const GLuint program = glCreateProgram();
        glAttachShader(program, compile(GL_VERTEX_SHADER, kVertexShader));
        glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragments));
        glLinkProgram(program);
        GLint good = 0;
        glGetProgramiv(program, GL_LINK_STATUS, &good);
        require(good, "the shaders do not fit together");
        glUseProgram(program);
        glUniformMatrix4fv(0, 1, GL_FALSE, matrix.data());
        return program;
    };
    s.flat = link(kFlatShader);
    s.shaded = link(kFragmentShader);
    glUniform3fv(1, 1, scene.eye.data());
    glUniform3fv(2, 2, scene.light_positions[0].data());
    glUniform3fv(4, 2, scene.light_colors[0].data());
    glUniform3fv(6, 1, scene.diffuse.data());
    glUniform3f(7, scene.specular, scene.shininess, scene.ambient);
}

GlPeer::~GlPeer() {
    eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(state_->display, state_->context);
    eglTerminate(state_->display);
}

void GlPeer::set_mesh(const IndexedMesh& mesh) {
    GLuint array = 0, buffers[3];
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(3, buffers);
    const std::vector<float>* const attributes[2] = {&mesh.positions, &mesh.normals};
    for (GLuint k = 0; k < 2; ++k) {
        glBindBuffer(GL_ARRAY_BUFFER, buffers[k]);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(attributes[k]->size() * sizeof(float)),
                     attributes[k]->data(), GL_STATIC_DRAW);
        glVertexAttribPointer(k, 3, GL_FLOAT, GL_FALSE, 3 * sizeof(float), nullptr);
        glEnableVertexAttribArray(k);
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[2]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(uint32_t)),
                 mesh.indices.data(), GL_STATIC_DRAW);
    state_->indices = static_cast<GLsizei>(mesh.indices.size());
}

void GlPeer::draw(Drawing drawing) {
    const State& s = *state_;
    glBindFramebuffer(GL_FRAMEBUFFER, s.drawn);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const auto triangles = [&](GLenum mode, float brightness) {
        glPolygonMode(GL_FRONT_AND_BACK, mode);
        glUniform1f(9, brightness);
        glDrawElements(GL_TRIANGLES, s.indices, GL_UNSIGNED_INT, nullptr);
    };
    if (drawing == Drawing::phong) {
        glUseProgram(s.shaded);
        glDrawElements(GL_TRIANGLES, s.indices, GL_UNSIGNED_INT, nullptr);
    } else {
        glUseProgram(s.flat);
        if (drawing == Drawing::hidden_line) {
            glEnable(GL_POLYGON_OFFSET_FILL);
            glPolygonOffset(1, 1);
            triangles(GL_FILL, 0);
        } else {
            glDisable(GL_CULL_FACE);
            glDisable(GL_DEPTH_TEST);
        }
        triangles(GL_LINE, 1);
    }
    if (s.resolved) {
        const auto w = static_cast<GLint>(s.width), h = static_cast<GLint>(s.height);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, s.resolved);
        glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
    glFinish();
}

std::vector<uint8_t> GlPeer::read() const {
    const State& s = *state_;
    std::vector<uint8_t> pixels(size_t{4} * s.width * s.height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, s.resolved ? s.resolved : s.drawn);
    glReadPixels(0, 0, static_cast<GLsizei>(s.width), static_cast<GLsizei>(s.height), GL_RGBA, GL_UNSIGNED_BYTE,
                 pixels.data());
    return pixels;
}

std::string GlPeer::renderer() const {
    return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

}  // namespace trp_bench
