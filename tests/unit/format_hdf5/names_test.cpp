// Names are read back as they were written, and each ends with a zero byte in the file, for libraries that look for
// one.
#include <gtest/gtest.h>
#include <hdf5.h>

#include "formats/hdf5/h5.h"
#include "support/temp_folder.h"

namespace suite::h5::format_hdf5_names_test {
namespace {

TEST(Names, AreNullTerminated) {
  const TempFolder folder;
  const std::string path = folder / "names.h5";
  const std::vector<std::string> names = {"grass", "", "the longest", "ä"};
  Writer writer(path, path);
  writer.put_names("/group/name", names);
  writer.put_names("/none", {});
  writer.close();

  EXPECT_EQ(Reader(path).get_names("/group/name", 4), names);
  EXPECT_TRUE(Reader(path).get_names("/none", 0).empty());

  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              dataset = H5Dopen2(file, "/group/name", H5P_DEFAULT), type = H5Dget_type(dataset);
  const size_t size = H5Tget_size(type);
  EXPECT_EQ(size, names[2].size() + 1);
  std::vector<char> all(size * names.size(), 'x');
  ASSERT_GE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()), 0);
  for (size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(all[(i + 1) * size - 1], '\0') << names[i];
    EXPECT_EQ(std::string(&all[i * size]), names[i]);
  }
  H5Tclose(type), H5Dclose(dataset), H5Fclose(file);
}

}  // namespace
}  // namespace suite::h5::format_hdf5_names_test
