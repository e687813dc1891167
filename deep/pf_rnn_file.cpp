#include <maximin/deep/pf_rnn_file.hpp>

#include <bit>
#include <cstdint>
#include <cstring>
#include <istream>
#include <iterator>
#include <ostream>
#include <sstream>
#include <utility>
#include <vector>

#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

const std::string magic = "maximin-pf-rnn 1\n";

std::uint64_t checksum(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return hash;
}

/// The options as names and numbers, in the order of the file.
struct OptionLine {
  std::vector<std::pair<std::string, double>> entries;

  explicit OptionLine(const PfRnnOptions& o)
      : entries{{"cell", static_cast<double>(o.cell)},
                {"particles", static_cast<double>(o.particles)},
                {"hidden", static_cast<double>(o.hidden)},
                {"embedding", static_cast<double>(o.embedding)},
                {"eps", o.eps},
                {"alpha", o.alpha},
                {"normalisation", static_cast<double>(o.normalisation)},
                {"read_out", static_cast<double>(o.read_out)},
                {"resampling", static_cast<double>(o.resampling)},
                {"weighing", static_cast<double>(o.weighing)},
                {"read_before_resampling", static_cast<double>(o.read_before_resampling)},
                {"cells", static_cast<double>(o.cells)},
                {"innovation", static_cast<double>(o.innovation)},
                {"one_hot_actions", static_cast<double>(o.one_hot_actions)}} {}
};

/// Numbers in a line of the file, one after another.
class OptionReader {
 public:
  OptionReader(std::istream& in, std::string where) : in_(in), where_(std::move(where)) {}

  double number(const std::string& name, double low, double high) {
    std::string read;
    double value = 0;
    if (!(in_ >> read >> value) || read != name || !(value >= low && value <= high)) {
      throw InputError(where_ + ": option " + name + " is missing or out of range, expected a number from " +
                       std::to_string(low) + " to " + std::to_string(high));
    }
    return value;
  }
  long integer(const std::string& name, long low, long high) {
    return static_cast<long>(number(name, static_cast<double>(low), static_cast<double>(high)));
  }
  bool flag(const std::string& name) { return integer(name, 0, 1) == 1; }
  template <class Enum>
  Enum choice(const std::string& name, Enum last) {
    return static_cast<Enum>(integer(name, 0, static_cast<long>(last)));
  }

 private:
  std::istream& in_;
  std::string where_;
};

PfRnnOptions read_options(std::istream& in, const std::string& where) {
  OptionReader read(in, where);
  PfRnnOptions o;
  o.cell = read.choice("cell", PfCell::gru);
  o.particles = read.integer("particles", 1, 10'000);
  o.hidden = read.integer("hidden", 1, 4096);
  o.embedding = read.integer("embedding", 1, 4096);
  o.eps = read.number("eps", 0, 5);
  o.alpha = read.number("alpha", 0, 1);
  o.normalisation = read.choice("normalisation", PfNormalisation::none);
  o.read_out = read.choice("read_out", PfReadOut::absolute);
  o.resampling = read.choice("resampling", PfResampling::multinomial);
  o.weighing = read.choice("weighing", PfWeighing::linear);
  o.read_before_resampling = read.flag("read_before_resampling");
  o.cells = read.flag("cells");
  o.innovation = read.flag("innovation");
  o.one_hot_actions = read.flag("one_hot_actions");
  return o;
}

/// Parameters and running statistics that are floats; a count of batches is no part of what a module computes.
std::vector<std::pair<std::string, torch::Tensor>> tensors_of(const PfRnn& module) {
  std::vector<std::pair<std::string, torch::Tensor>> all;
  for (const auto& item : module.named_parameters()) all.emplace_back(item.key(), item.value());
  for (const auto& item : module.named_buffers()) {
    if (item.value().is_floating_point()) all.emplace_back(item.key(), item.value());
  }
  return all;
}

std::string heading(const std::string& name, const torch::Tensor& tensor) {
  std::string line = name;
  for (const std::int64_t size : tensor.sizes()) line += ' ' + std::to_string(size);
  return line + '\n';
}

void read_tensor(std::istream& in, const std::string& name, torch::Tensor tensor, const std::string& where) {
  const std::string expected = heading(name, tensor);
  std::string line;
  std::getline(in, line);
  if (line + '\n' != expected) {
    throw InputError(where + ": expected the tensor '" + expected.substr(0, expected.size() - 1) + "'");
  }
  torch::Tensor values = torch::empty(tensor.sizes());
  const auto bytes = static_cast<std::streamsize>(values.nbytes());
  in.read(static_cast<char*>(values.data_ptr()), bytes);
  if (in.gcount() != bytes || in.get() != '\n') throw InputError(where + ": tensor " + name + " is cut off");
  if (!torch::isfinite(values).all().item<bool>()) {
    throw InputError(where + ": tensor " + name + " holds a number that is not finite");
  }
  tensor.copy_(values);
}

}  // namespace

void save_pf_rnn(std::ostream& out, const PfRnn& module) {
  const torch::NoGradGuard no_grad;
  std::ostringstream body;
  body.precision(17);
  body << magic;
  const char* gap = "";
  for (const auto& [name, value] : OptionLine(module.options()).entries) {
    body << gap << name << ' ' << value;
    gap = " ";
  }
  body << '\n';
  for (const auto& [name, tensor] : tensors_of(module)) {
    const torch::Tensor values = tensor.to(torch::kCPU, torch::kFloat).contiguous();
    body << heading(name, values);
    body.write(static_cast<const char*>(values.data_ptr()), static_cast<std::streamsize>(values.nbytes()));
    body << '\n';
  }
  const std::string bytes = body.str();
  const std::uint64_t sum = checksum(bytes);
  out << bytes;
  out.write(reinterpret_cast<const char*>(&sum), sizeof sum);
  if (!out.flush()) throw InputError("PF-RNN: the file cannot be written");
}

PfRnnPtr load_pf_rnn(std::istream& in, const std::string& where) {
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const std::string kind = magic.substr(0, magic.find(' ') + 1);
  if (!bytes.starts_with(kind))
    throw InputError(where + ": no PF-RNN, expected a file that begins with '" + kind + "1'");
  if (!bytes.starts_with(magic)) throw InputError(where + ": a PF-RNN of another version, expected version 1");
  std::uint64_t sum = 0;
  const std::size_t length = bytes.size() - magic.size() < sizeof sum ? 0 : bytes.size() - sizeof sum;
  std::memcpy(&sum, bytes.data() + length, std::min(sizeof sum, bytes.size() - length));
  bytes.resize(length);
  if (length == 0 || sum != checksum(bytes)) {
    throw InputError(where + ": cut off or damaged, its checksum is wrong, expected a file as save_pf_rnn wrote it");
  }
  std::istringstream body(bytes.substr(magic.size()));
  const PfRnnOptions options = read_options(body, where);
  body.get();
  Stream rng(0);
  auto module = std::make_shared<PfRnn>(options, rng);
  const torch::NoGradGuard no_grad;
  for (const auto& [name, tensor] : tensors_of(*module)) read_tensor(body, name, tensor, where);
  if (body.peek() != std::istringstream::traits_type::eof()) {
    throw InputError(where + ": more than a PF-RNN, expected the end of the file");
  }
  module->eval();
  return module;
}

}  // namespace maximin::deep
