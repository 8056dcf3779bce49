// The one translation unit that holds tinygltf. It parses JSON and buffers; images are never opened, and files only by
// what load.cpp gives it.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <fstream>  // its writers want it, which nobody calls

#include <tiny_gltf.h>
