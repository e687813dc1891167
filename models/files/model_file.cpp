#include <maximin/models/files/model_file.hpp>

#include <maximin/models/files/internal/file_bytes.hpp>
#include <maximin/models/files/maximin_json.hpp>

namespace maximin {

template <class Scalar>
Model<Scalar> load_model(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string text = internal::file_bytes(path, options.limits.bytes);
  return read_maximin_json<Scalar>(text, path.string(), options);
}

template Model<double> load_model(const std::filesystem::path&, const ReadOptions&);

}  // namespace maximin
