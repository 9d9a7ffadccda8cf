#include "evaluation/image_codecs.h"

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>

#include "evaluation/opencv_codecs.h"

namespace rotrocc {
namespace {

constexpr const char* kLibrary = "librotrocc_image_codecs.so";

/// Beside this one, if it is there. (The dlopen() of AddressSanitizer does not know an RPATH.)
std::string libraryPath() {
  Dl_info own = {};
  if (dladdr(&kLibrary, &own) == 0) return kLibrary;
  const auto path = std::filesystem::path(own.dli_fname).replace_filename(kLibrary);
  return std::filesystem::exists(path) ? path.string() : kLibrary;
}

/// `file` needs them.
const OpenCvCodecs& load(const std::string& file) {
  void* const library = dlopen(libraryPath().c_str(), RTLD_NOW);
  void* const codecs = library == nullptr ? nullptr : dlsym(library, "rotrocc_image_codecs");
  if (codecs != nullptr) return *static_cast<const OpenCvCodecs*>(codecs);
  throw std::runtime_error(file + " is not PNG, so it needs " + kLibrary +
                           ", which cannot be loaded (" + dlerror() +
                           "): install all libraries of rotrocc, or use PNG");
}

/// Once loaded, they stay so.
const OpenCvCodecs& openCvCodecs(const std::string& file) {
  static const OpenCvCodecs& codecs = load(file);
  return codecs;
}

}  // namespace

cv::Mat readGreyByOpenCv(const std::string& path) {
  return openCvCodecs(path).read_grey(path);
}

std::vector<unsigned char> encodeByOpenCv(const std::string& extension, const cv::Mat& image) {
  return openCvCodecs(extension).encode(extension, image);
}

}  // namespace rotrocc
