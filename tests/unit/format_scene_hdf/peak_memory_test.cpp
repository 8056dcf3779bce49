// A prepared scene that claims far more than it holds costs no memory: 4e8 indices packed into some 1.6 MB are refused
// before memory is asked for. The peak is that of a process of its own (wait4's ru_maxrss).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "base/files.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/scene_text/scene_text.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_scene_hdf_peak_memory_test {
namespace {

constexpr double kMost = 300;  // MiB, of which the program and its libraries are some 50

// What a process that does this reaches, MiB.
double peak_of(const std::function<void()>& action) {
  const pid_t child = fork();
  if (child == 0) {
    action();
    _exit(0);
  }
  int status = 0;
  rusage usage{};
  EXPECT_EQ(wait4(child, &status, 0, &usage), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// In place of the scene's indices, 4e8 zeros of 32 bits. The pieces are written packed: the file is as large as theirs.
void claim_indices(const std::string& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  ASSERT_GE(H5Ldelete(file, "/geometry/indices", H5P_DEFAULT), 0);
  const hsize_t count = 400'000'000, chunk = 4 << 20;
  const hid_t packed = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(1, &count, nullptr),
              text = H5Tcopy(H5T_C_S1), one = H5Screate(H5S_SCALAR);
  H5Pset_chunk(packed, 1, &chunk), H5Pset_shuffle(packed), H5Pset_deflate(packed, 9);
  H5Pset_fill_time(packed, H5D_FILL_TIME_ALLOC), H5Pset_alloc_time(packed, H5D_ALLOC_TIME_EARLY);
  const hid_t data = H5Dcreate2(file, "/geometry/indices", H5T_STD_U32LE, space, H5P_DEFAULT, packed, H5P_DEFAULT);
  ASSERT_GE(data, 0);
  H5Tset_cset(text, H5T_CSET_UTF8), H5Tset_strpad(text, H5T_STR_NULLPAD);
  const hid_t units = H5Acreate2(data, "units", text, one, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(units, text, "1");
  H5Aclose(units), H5Dclose(data), H5Sclose(space), H5Sclose(one), H5Tclose(text), H5Pclose(packed), H5Fclose(file);
}

TEST(PeakMemory, OfASceneThatClaimsTooMuch) {
  const TempFolder folder;
  const std::string path = folder / "scene.h5";
  write_file(folder / "tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl grey\nf 1 2 3\n");
  write_file(folder / "s.yaml",
             "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {tri: {obj: tri.obj}}\nworld: "
             "[{place: tri}]\n");
  Report report(scene_issues());
  write_scene(bake_scene(read_scene_text(folder / "s.yaml", {}, report), report), {"g", "a", "h", {{"", "00"}}}, path);
  ASSERT_TRUE(report.ok()) << report.text();
  claim_indices(path);
  EXPECT_LT(file_size(path), 4u << 20);
  EXPECT_LT(peak_of([&] {
              // In the child a failed expectation is an exit code.
              if (message_of([&] { read_scene(path); }).find("times the") == std::string::npos) _exit(1);
            }),
            kMost);
  // The measure sees memory that is used.
  EXPECT_GT(peak_of([] {
              std::vector<char> much(400 << 20);
              for (size_t i = 0; i < much.size(); i += 4096) const_cast<volatile char*>(much.data())[i] = 1;
            }),
            kMost);
}

}  // namespace
}  // namespace suite::format_scene_hdf_peak_memory_test
