#include "evaluation/png.h"

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <new>
#include <stdexcept>

#include <png.h>

#include "common/sentence.h"

namespace rotrocc {
namespace {

constexpr std::uint64_t kMaxPixels = 1U << 30;                           // that of cv::imread()
constexpr bool kSwapsBytes = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;  // PNG is big-endian

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
using Bytes = std::vector<unsigned char>;

/// What libpng says of an error.
struct Complaint {
  char text[80] = "";
};

void onError(png_structp png, png_const_charp text) {
  auto* complaint = static_cast<Complaint*>(png_get_error_ptr(png));
  std::snprintf(complaint->text, sizeof(complaint->text), "%s", text);
  png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

/// Throws std::runtime_error if a call of libpng fails. It leaves `calls` by longjmp, which skips
/// destructors: no object there may need one.
template <class Calls>
void run(png_structp png, const Complaint& complaint, const Calls& calls) {
  if (setjmp(png_jmpbuf(png)) != 0) throw std::runtime_error(complaint.text);
  calls();
}

class PngReader {
 public:
  PngReader()
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &complaint_, onError, ignoreWarning)),
        info_(png_create_info_struct(png_)) {}
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  cv::Mat read(std::FILE* file);

 private:
  void readHeader(std::FILE* file);
  cv::Mat makeImage() const;
  void readRows(cv::Mat& image);

  Complaint complaint_;
  png_structp png_;
  png_infop info_;
  int passes_ = 1;
};

cv::Mat PngReader::read(std::FILE* file) {
  if (info_ == nullptr) throw std::bad_alloc();
  readHeader(file);
  cv::Mat image = makeImage();
  readRows(image);
  return image;
}

/// The same conversions as those of OpenCV.
void PngReader::readHeader(std::FILE* file) {
  run(png_, complaint_, [&] {
    png_init_io(png_, file);
    png_read_info(png_, info_);
    if (kSwapsBytes) png_set_swap(png_);
    png_set_strip_alpha(png_);
    png_set_expand(png_);  // palettes, and pixels of less than 8 bits
    png_set_rgb_to_gray(png_, PNG_ERROR_ACTION_NONE, 0.299, 0.587);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
  });
}

cv::Mat PngReader::makeImage() const {
  const std::uint64_t width = png_get_image_width(png_, info_);
  const std::uint64_t height = png_get_image_height(png_, info_);
  if (width * height > kMaxPixels) {
    throw std::runtime_error(sentence(width, " x ", height, " px are more than 2^30"));
  }
  return cv::Mat(static_cast<int>(height),
                 static_cast<int>(width),
                 png_get_bit_depth(png_, info_) == 16 ? CV_16UC1 : CV_8UC1);
}

void PngReader::readRows(cv::Mat& image) {
  run(png_, complaint_, [&] {
    for (int pass = 0; pass < passes_; ++pass) {
      for (int y = 0; y < image.rows; ++y) png_read_row(png_, image.ptr(y), nullptr);
    }
    png_read_end(png_, nullptr);
  });
}

class PngWriter {
 public:
  PngWriter()
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint_, onError, ignoreWarning)),
        info_(png_create_info_struct(png_)) {}
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  void write(const cv::Mat& image, Bytes& bytes);

 private:
  static void append(png_structp png, png_bytep data, png_size_t size);
  static void flush(png_structp) {}

  Complaint complaint_;
  png_structp png_;
  png_infop info_;
};

void PngWriter::append(png_structp png, png_bytep data, png_size_t size) {
  auto* bytes = static_cast<Bytes*>(png_get_io_ptr(png));
  try {
    bytes->insert(bytes->end(), data, data + size);
    return;
  } catch (const std::bad_alloc&) {
  }
  png_error(png, "out of memory");
}

/// The fastest compression that is as small as that of higher levels, which is also OpenCV's.
void PngWriter::write(const cv::Mat& image, Bytes& bytes) {
  if (info_ == nullptr) throw std::bad_alloc();
  const bool grey = image.channels() == 1;
  const int bits = image.depth() == CV_16U ? 16 : 8;
  run(png_, complaint_, [&] {
    png_set_write_fn(png_, &bytes, append, flush);
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png_, 1);
    constexpr int kRunLengths = 3;  // Z_RLE of zlib
    png_set_compression_strategy(png_, kRunLengths);
    png_set_IHDR(png_,
                 info_,
                 static_cast<png_uint_32>(image.cols),
                 static_cast<png_uint_32>(image.rows),
                 bits,
                 grey ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    if (!grey) png_set_bgr(png_);
    if (kSwapsBytes && bits == 16) png_set_swap(png_);
    for (int y = 0; y < image.rows; ++y) png_write_row(png_, image.ptr(y));
    png_write_end(png_, info_);
  });
}

}  // namespace

bool isPng(const std::string& path) {
  const File file(std::fopen(path.c_str(), "rb"), std::fclose);
  png_byte signature[8];
  return file && std::fread(signature, 1, sizeof(signature), file.get()) == sizeof(signature) &&
         png_sig_cmp(signature, 0, sizeof(signature)) == 0;
}

cv::Mat readGreyPng(const std::string& path) {
  const File file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw std::runtime_error("cannot open " + path);
  try {
    return PngReader().read(file.get());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + " is not a readable image (" + error.what() +
                             "): is it incomplete or damaged? Copy it again");
  }
}

Bytes encodePng(const cv::Mat& image) {
  CV_Assert((image.depth() == CV_8U || image.depth() == CV_16U) &&
            (image.channels() == 1 || image.channels() == 3));
  Bytes bytes;
  PngWriter().write(image, bytes);
  return bytes;
}

void writePng(const std::string& path, const cv::Mat& image) {
  const Bytes bytes = encodePng(image);
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path + ": is the disk full?");
}

}  // namespace rotrocc
