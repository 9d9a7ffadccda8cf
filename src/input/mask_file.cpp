#include "input/mask_file.h"

#include <png.h>

#include <filesystem>
#include <stdexcept>

namespace rotrocc {

/// By libpng, as OpenCV's library for files loads 100 others.
cv::Mat readMask(const std::string& path) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  cv::Mat grey;
  if (png_image_begin_read_from_file(&png, path.c_str()) != 0) {
    png.format = PNG_FORMAT_GRAY;
    grey.create(static_cast<int>(png.height), static_cast<int>(png.width), CV_8UC1);
    const png_color black = {};
    const auto step = static_cast<png_int_32>(grey.step);
    png_image_finish_read(&png, &black, grey.data, step, nullptr);
  }
  if (PNG_IMAGE_FAILED(png)) {
    throw std::runtime_error("the mask " + std::filesystem::absolute(path).string() +
                             " cannot be read as a PNG file: " + png.message +
                             "; check the parameter mask");
  }
  return grey > 0;
}

std::string pathOfSide(std::string path, const std::string& side) {
  const std::size_t place = path.find("%s");
  return place == std::string::npos ? path : path.replace(place, 2, side);
}

}  // namespace rotrocc
