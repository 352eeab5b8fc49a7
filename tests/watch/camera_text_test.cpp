// Where a camera stands by its file, and what is written there to make it stand elsewhere.
#include "core/watch/camera_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "parser/parse.h"
#include "parser/transforms.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

struct Read {
  std::unique_ptr<Sources> sources = std::make_unique<Sources>();
  ParseResult parsed;
  const SceneDescription& world() const { return parsed.scenes.front(); }
  Mat4d camera() const { return world().transforms[static_cast<size_t>(world().camera_transform)].start; }
};

Read read_text(const std::string& text) {
  Read out;
  out.parsed = parse_text(*out.sources, "scene.pbrt", text, "");
  return out;
}

const std::string kWorld = "WorldBegin\nShape \"sphere\"\nWorldEnd\n";

double largest_difference(const Mat4d& a, const Mat4d& b) {
  double most = 0;
  for (int i = 0; i < 16; ++i) most = std::max(most, std::abs(a[i / 4][i % 4] - b[i / 4][i % 4]));
  return most;
}

std::string edited(const Read& read, const CameraEdit& edit) {
  const std::string text(read.sources->text(edit.file));
  return text.substr(0, edit.begin) + edit.text + text.substr(edit.end);
}

/// Moves the camera of a text, and reads what comes of it.
std::string moved(const std::string& text, const CameraPose& pose) {
  const Read before = read_text(text);
  const Mat4d wanted = placed_at(before.camera(), pose);
  const CameraEdit edit = camera_edit(*before.sources, before.world(), wanted, pose.up);
  EXPECT_EQ(edit.problem, "") << text;
  const std::string after = edited(before, edit);
  EXPECT_LT(largest_difference(read_text(after).camera(), wanted), 1e-7) << after;
  return after;
}

const CameraPose kPose{{1.25, -2, 3.5}, Vec3d(0.3, 0.2, -1).normalized(), {0, 1, 0}};

TEST(CameraText, PoseOfALookAt) {
  // LookAt's own numbers; +z of camera space is the direction of view.
  const CameraPose pose = pose_of(*looking_at({1, 2, 3}, {1, 2, 8}, {0, 1, 0}));
  EXPECT_LT((pose.eye - Vec3d(1, 2, 3)).length(), 1e-12);
  EXPECT_LT((pose.direction - Vec3d(0, 0, 1)).length(), 1e-12);
  EXPECT_LT((pose.up - Vec3d(0, 1, 0)).length(), 1e-12);
}

TEST(CameraText, MovedCamerasStandWhereTheyShould) {
  const CameraPose there = pose_of(placed_at(*looking_at({0, 0, -5}, {0, 0, 0}, {0, 1, 0}), kPose));
  EXPECT_LT((there.eye - kPose.eye).length(), 1e-12);
  EXPECT_LT((there.direction - kPose.direction).length(), 1e-12);
}

TEST(CameraText, KeepsWhatMirrorsAndScales) {
  for (const char* before :
       {"Scale -1 1 1\nLookAt 0 0 -5  0 0 0  0 1 0\n", "LookAt 0 0 -5  0 0 0  0 1 0\nScale -1 1 1\n",
        "Scale 2 2 2\nLookAt 0 0 -5  0 0 0  0 1 0\n"}) {
    const std::string text = moved(before + std::string("Camera \"perspective\"\n") + kWorld, kPose);
    EXPECT_NE(text.find("Scale"), std::string::npos) << text;
    EXPECT_NE(text.find("LookAt"), std::string::npos) << text;
  }
}

TEST(CameraText, ReplacesTheLookAtAlone) {
  const std::string text =
      moved("# before\nLookAt 0 0 -5\n  0 0 0 0 1 0  # behind\nCamera \"perspective\"\n" + kWorld, kPose);
  EXPECT_EQ(text.substr(0, 9), "# before\n");
  EXPECT_NE(text.find("  # behind\nCamera"), std::string::npos) << text;
  EXPECT_NE(text.find("LookAt 1.25 -2 3.5  "), std::string::npos) << text;
  // The point that is looked at stays as far away as it was, five units: its direction has the length 1.
  const Read read = read_text(text);
  EXPECT_LT((pose_of(read.camera()).eye - kPose.eye).length(), 1e-12);
}

TEST(CameraText, EveryKindOfPlace) {
  for (const char* before :
       {"", "Translate 0 0 5\n", "Rotate 30 0 1 0\nTranslate 0 0 5\n",
        "Translate 0 0 5\nRotate 180 1 0 0\nScale -1 1 1\n", "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 5 1]\n",
        "ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 5 1]\n", "Translate 9 9 9\nIdentity\nLookAt 0 0 -5 0 0 0 0 1 0\n",
        "Rotate 10 0 0 1\nLookAt 0 0 -5 0 0 0 0 1 0\nTranslate 1 0 0\n", "Scale 1 2 3\nTranslate 0 1 0\n"})
    moved(before + std::string("Camera \"perspective\"\n") + kWorld, kPose);
}

TEST(CameraText, LargeAndSmallScenesKeepTheirDigits) {
  for (const double size : {1e-4, 1.0, 1e5}) {
    const Read before = read_text("LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\"\n" + kWorld);
    const CameraPose pose{Vec3d(1.0 / 3, 2.0 / 3, 1.0 / 7) * size, Vec3d(1, 2, 3).normalized(), {0, 1, 0}};
    const CameraEdit edit = camera_edit(*before.sources, before.world(), placed_at(before.camera(), pose), {0, 1, 0});
    const CameraPose read = pose_of(read_text(edited(before, edit)).camera());
    EXPECT_LT((read.eye - pose.eye).length(), 1e-6 * size) << edit.text;
    EXPECT_LT((read.direction - pose.direction).length(), 1e-6) << edit.text;
  }
}

TEST(CameraText, RefusesWhatItDoesNotUnderstand) {
  const auto problem = [](const std::string& text) {
    const Read read = read_text(text);
    return camera_edit(*read.sources, read.world(), read.camera(), {0, 1, 0}).problem;
  };
  EXPECT_NE(problem(kWorld).find("no Camera"), std::string::npos);
  EXPECT_NE(problem("ActiveTransform StartTime Translate 0 0 5 ActiveTransform All\nCamera \"perspective\"\n" + kWorld)
                .find("moves"),
            std::string::npos);
  EXPECT_NE(problem("Translate 0 0 5 # far\nRotate 5 0 1 0\nCamera \"perspective\"\n" + kWorld).find("from line 1"),
            std::string::npos);
  // A comment inside of what would be replaced.
  for (const char* inside : {"LookAt 0 0 -5 # eye\n 0 0 0 0 1 0\n",
                             "Transform [1 0 0 0 0 1 0 0 # here\n 0 0 1 0 0 0 5 1]\n", "Translate 0 # far\n 0 5\n"})
    EXPECT_NE(problem(inside + std::string("Camera \"perspective\"\n") + kWorld).find("comment"), std::string::npos);
  EXPECT_NE(problem("Translate 0 0 5\nCoordinateSystem \"there\"\nIdentity\nCoordSysTransform \"there\"\nCamera "
                    "\"perspective\"\n" +
                    kWorld)
                .find("not all stand"),
            std::string::npos);
}

TEST(CameraText, UpIsTheFiles) {
  const Read read = read_text("LookAt 0 0 -5  0 -1 0  0 0 2\nCamera \"perspective\"\n" + kWorld);
  EXPECT_LT((up_of_camera(*read.sources, read.world()) - Vec3d(0, 0, 1)).length(), 1e-12);
}

TEST(CameraText, WritesOnlyOverWhatWasRead) {
  const std::string path = test::temp_path("scene.pbrt"),
                    text = "LookAt 0 0 -5 0 0 0 0 1 0\nCamera \"perspective\"\n" + kWorld;
  const auto put = [&](const std::string& t) { std::ofstream(path, std::ios::binary) << t; };
  const auto get = [&] {
    std::ifstream in(path, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  put(text);
  Sources sources;
  sources.copy_files();
  const ParseResult parsed = parse_file(sources, path);
  const SceneDescription& world = parsed.scenes.front();
  const Mat4d camera = world.transforms[static_cast<size_t>(world.camera_transform)].start;
  const CameraEdit edit = camera_edit(sources, world, placed_at(camera, kPose), kPose.up);
  put(text + "# more\n");
  EXPECT_NE(write_edit(sources, edit), "");
  EXPECT_EQ(get(), text + "# more\n");
  put(text);
  EXPECT_EQ(write_edit(sources, edit), "");
  EXPECT_EQ(get(), edit.text + text.substr(edit.end));
  // A file that may not be written, and another name of it.
  namespace fs = std::filesystem;
  put(text);
  fs::permissions(path, fs::perms::owner_read);
  EXPECT_NE(write_edit(sources, edit).find("write-protected"), std::string::npos);
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(get(), text);
  const std::string other = test::temp_path("other.pbrt");
  fs::remove(other);
  fs::create_hard_link(path, other);
  EXPECT_EQ(write_edit(sources, edit), "");
  EXPECT_TRUE(fs::equivalent(path, other));
  EXPECT_EQ(get(), edit.text + text.substr(edit.end));
}

}  // namespace
}  // namespace whit
