#include "pirouette/model/spec_repair.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>

#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackage = "package://";

/// Calls `visit` with every element of a type; `visit` may delete the one it gets.
template <class Visit>
void for_each(mjSpec& spec, mjtObj type, Visit&& visit) {
  std::vector<mjsElement*> all;
  for (mjsElement* e = mjs_firstElement(&spec, type); e; e = mjs_nextElement(&spec, e))
    all.push_back(e);
  for (mjsElement* e : all) visit(e);
}

std::string lower_extension(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Where the mesh file `name` is: as it stands, below the mesh folder, or, for a package, below a
/// folder around the robot's file. Empty: nowhere.
fs::path find_mesh(const std::string& name, const fs::path& folder, const fs::path& mesh_folder) {
  if (name.rfind(kPackage, 0) != 0) {
    const fs::path path = folder / mesh_folder / name;
    return fs::is_regular_file(path) ? path : fs::path();
  }
  const fs::path in_package = name.substr(kPackage.size());
  fs::path below_name;  // without the name of the package
  for (auto part = std::next(in_package.begin()); part != in_package.end(); ++part)
    below_name /= *part;
  for (fs::path around = fs::absolute(folder).lexically_normal();; around = around.parent_path()) {
    for (const fs::path& candidate : {around / in_package, around / below_name}) {
      if (fs::is_regular_file(candidate)) return candidate;
    }
    if (!around.has_relative_path()) return {};
  }
}

/// Whether MuJoCo computes the body's mass from this geom.
bool gives_mass(const mjSpec& spec, const mjsBody& body, const mjsGeom& geom) {
  if (spec.compiler.inertiafromgeom == mjINERTIAFROMGEOM_FALSE) return false;
  const bool of_geoms =
      spec.compiler.inertiafromgeom == mjINERTIAFROMGEOM_TRUE || !body.explicitinertial;
  const int* groups = spec.compiler.inertiagrouprange;
  const bool counts = groups[0] <= geom.group && geom.group <= groups[1];
  const bool weighs = !std::isnan(geom.mass) ? geom.mass > 0.0 : geom.density > 0.0;
  return of_geoms && counts && weighs;
}

}  // namespace

std::string name_of(mjsElement* element) { return mjs_getString(mjs_getName(element)); }

void name_all(mjSpec& spec) {
  const auto name_those = [&](mjtObj type, const std::string& what) {
    int number = 0;
    for_each(spec, type, [&](mjsElement* e) {
      const std::string name = what + "_" + std::to_string(number++);
      const bool is_free = mjs_findElement(&spec, type, name.c_str()) == nullptr;
      if (name_of(e).empty() && is_free) mjs_setName(e, name.c_str());
    });
  };
  name_those(mjOBJ_BODY, "body");
  name_those(mjOBJ_JOINT, "joint");
  name_those(mjOBJ_GEOM, "geom");
}

Errors mend_meshes(mjSpec& spec, const std::string& file, std::vector<std::string>& notes) {
  const fs::path folder = fs::path(file).parent_path();
  const auto below = [&](const mjString* given) { return fs::path(mjs_getString(given)); };

  std::map<std::string, std::string> unreadable;  // mesh -> why
  for_each(spec, mjOBJ_MESH, [&](mjsElement* e) {
    mjsMesh& mesh = *mjs_asMesh(e);
    const std::string given = mjs_getString(mesh.file);
    if (given.empty()) return;
    const fs::path path = find_mesh(given, folder, below(mjs_getCompiler(e)->meshdir));
    const std::string name = name_of(e).empty() ? fs::path(given).stem().string() : name_of(e);
    static const std::set<std::string> kReadable = {".stl", ".obj", ".msh"};
    if (path.empty()) {
      unreadable[name] = "there is no file " + given;
    } else if (kReadable.count(lower_extension(path)) == 0) {
      unreadable[name] = "MuJoCo reads no " + lower_extension(path);
    } else if (given.rfind(kPackage, 0) == 0) {
      mjs_setString(mesh.file, fs::absolute(path).c_str());
    }
  });

  Errors errors;
  std::map<std::string, int> shapes_left_out;  // why -> how many
  std::set<std::string> reported;
  for_each(spec, mjOBJ_GEOM, [&](mjsElement* e) {
    const mjsGeom& geom = *mjs_asGeom(e);
    const auto found = unreadable.find(mjs_getString(geom.meshname));
    if (geom.type != mjGEOM_MESH || found == unreadable.end()) return;
    const mjsBody& body = *mjs_getParent(e);
    const std::string of_body = "body " + name_of(body.element);
    const bool collides = geom.contype != 0 || geom.conaffinity != 0;
    const bool is_missing = found->second.rfind("there", 0) == 0;
    if (gives_mass(spec, body, geom) || (collides && is_missing)) {
      if (reported.insert(found->first).second) {
        errors.push_back({file, 0, "mesh " + found->first,
                          found->second + ", and it is the " +
                              (collides ? "collision shape" : "mass") + " of " + of_body +
                              "; put the file there, or give the body " +
                              (collides ? "another collision shape" : "an <inertial>")});
      }
      return;
    }
    if (collides)
      notes.push_back(of_body + " has no collision shape " + found->first + ": " + found->second);
    else
      ++shapes_left_out[found->second];
    mjs_delete(&spec, e);
  });
  if (!errors.empty()) return errors;
  if (!shapes_left_out.empty()) {
    notes.push_back("it will not look as it does: " + shapes_left_out.begin()->first +
                    (unreadable.size() > 1
                         ? ", and " + std::to_string(unreadable.size() - 1) + " other meshes"
                         : ""));
  }
  for_each(spec, mjOBJ_MESH, [&](mjsElement* e) {
    const std::string given = mjs_getString(mjs_asMesh(e)->file);
    const std::string name = name_of(e).empty() ? fs::path(given).stem().string() : name_of(e);
    if (!given.empty() && unreadable.count(name) != 0) mjs_delete(&spec, e);
  });

  for_each(spec, mjOBJ_TEXTURE, [&](mjsElement* e) {
    mjsTexture& texture = *mjs_asTexture(e);
    const std::string given = mjs_getString(texture.file);
    if (given.empty()) return;
    if (fs::is_regular_file(folder / below(mjs_getCompiler(e)->texturedir) / given)) return;
    mjs_setString(texture.file, "");
    texture.builtin = mjBUILTIN_FLAT;
    texture.width = texture.height = 1;
    if (texture.type != mjTEXTURE_2D) texture.height = 6;
    notes.push_back("it will not look as it does: there is no texture " + given);
  });
  return {};
}

Mat3 possible_inertia(const Mat3& inertia) {
  // The second moment of the mass about the CoM, of which the inertia is tr(S) 1 - S, is that of
  // some body if and only if no eigenvalue is negative.
  const Mat3 second_moment = 0.5 * inertia.trace() * Mat3::Identity() - inertia;
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(second_moment);
  const double least = 1e-3 * std::abs(inertia.trace());
  if (solver.eigenvalues().minCoeff() >= -1e-12 * std::abs(inertia.trace())) return inertia;
  const Vec3 moments = solver.eigenvalues().cwiseMax(least);
  const Mat3 S = solver.eigenvectors() * moments.asDiagonal() * solver.eigenvectors().transpose();
  return S.trace() * Mat3::Identity() - S;
}

void mend_inertias(mjSpec& spec, std::vector<std::string>& notes) {
  std::string mended;
  for_each(spec, mjOBJ_BODY, [&](mjsElement* e) {
    mjsBody& body = *mjs_asBody(e);
    if (!body.explicitinertial || body.mass <= 0.0) return;
    double* full = body.fullinertia;  // xx yy zz xy xz yz
    const bool is_full = !std::isnan(full[0]);
    Mat3 inertia = Eigen::Map<const Vec3>(body.inertia).asDiagonal();
    if (is_full)
      inertia << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
    if (!inertia.allFinite()) return;  // MuJoCo says what it is
    const Mat3 possible = possible_inertia(inertia);
    if (possible == inertia) return;
    if (is_full) {
      full[0] = possible(0, 0), full[1] = possible(1, 1), full[2] = possible(2, 2);
      full[3] = possible(0, 1), full[4] = possible(0, 2), full[5] = possible(1, 2);
    } else {
      Eigen::Map<Vec3>(body.inertia) = possible.diagonal();
    }
    mended += (mended.empty() ? "" : ", ") + name_of(e);
  });
  if (!mended.empty())
    notes.push_back("no body has the inertia of " + mended + ": the nearest possible one is used");
}

void add_free_joint(mjSpec& spec, std::vector<std::string>& notes) {
  bool has_one = false;
  for_each(spec, mjOBJ_JOINT,
           [&](mjsElement* e) { has_one = has_one || mjs_asJoint(e)->type == mjJNT_FREE; });
  if (has_one) return;
  // The heaviest tree in the world is the robot; its root is the trunk.
  mjsBody* trunk = nullptr;
  int most = 0;
  const mjsBody* world = mjs_findBody(&spec, "world");
  for (mjsElement* e = mjs_firstChild(world, mjOBJ_BODY, 0); e;
       e = mjs_nextChild(world, e, /*recurse=*/0)) {
    mjsBody* root = mjs_asBody(e);
    int joints = 0;
    for (mjsElement* j = mjs_firstChild(root, mjOBJ_JOINT, 1); j;
         j = mjs_nextChild(root, j, /*recurse=*/1))
      ++joints;
    if (joints > most) most = joints, trunk = root;
  }
  if (trunk == nullptr || mjs_firstChild(trunk, mjOBJ_JOINT, 0) != nullptr) return;
  mjsJoint* joint = mjs_addFreeJoint(trunk);
  mjs_setName(joint->element, "free_trunk");
  notes.push_back("no free joint: body " + name_of(trunk->element) + " was given one");
}

void lock_joint(mjSpec& spec, mjsJoint& joint, double value) {
  mjsBody& body = *mjs_getParent(joint.element);
  if (body.alt.type != mjORIENTATION_QUAT) {
    const mjsCompiler* compiler = mjs_getCompiler(body.element);
    mjs_resolveOrientation(body.quat, compiler->degree, compiler->eulerseq, &body.alt);
    body.alt.type = mjORIENTATION_QUAT;
  }
  const Quat R(body.quat[0], body.quat[1], body.quat[2], body.quat[3]);
  const Vec3 axis = Eigen::Map<const Vec3>(joint.axis).normalized();
  const Vec3 anchor = Eigen::Map<const Vec3>(joint.pos);
  Eigen::Map<Vec3> position(body.pos);
  const bool in_degrees = mjs_getCompiler(joint.element)->degree != 0;
  const double moved = value - (in_degrees ? radians(joint.ref) : joint.ref);
  if (joint.type == mjJNT_SLIDE) {
    position += moved * (R * axis);
  } else if (joint.type == mjJNT_HINGE) {
    const Quat turn(Eigen::AngleAxisd(moved, axis));
    position += R * (anchor - turn * anchor);
    const Quat turned = (R * turn).normalized();
    body.quat[0] = turned.w(), body.quat[1] = turned.x();
    body.quat[2] = turned.y(), body.quat[3] = turned.z();
  }
  mjs_delete(&spec, joint.element);
}

}  // namespace pirouette
