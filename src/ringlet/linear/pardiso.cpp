#include "ringlet/linear/direct.h"

#include <mutex>
#include <omp.h>
#include <stdexcept>
#ifndef _WIN32
#include <dlfcn.h>
#else // of windows.h, which defines words such as near and far
extern "C" __declspec(dllimport) void *__stdcall LoadLibraryA(const char *name);
extern "C" __declspec(dllimport) void *__stdcall GetProcAddress(void *library, const char *name);
#endif

namespace ringlet {
namespace {

using PardisoIndex = long long; // of pardiso_64, whatever the library's default is

// Functions of the library, as its manual declares them.
struct Library {
    void (*pardiso)(void *handle, const PardisoIndex *factors, const PardisoIndex *number, const PardisoIndex *type,
                    const PardisoIndex *phase, const PardisoIndex *rows, const void *values, const PardisoIndex *starts,
                    const PardisoIndex *columns, PardisoIndex *permutation, const PardisoIndex *right_sides,
                    PardisoIndex *settings, const PardisoIndex *verbose, void *b, void *x, PardisoIndex *error);
    int (*set_threading_layer)(int layer);
    int (*set_threads)(int count);
};

// A library that is open for good, its functions, its names, and which threads it shares with the core: one pool of OpenMP.
#ifdef _WIN32
void *open_library(const char *name) { return LoadLibraryA(name); }
void *symbol_of(void *handle, const char *name) { return GetProcAddress(handle, name); }
constexpr const char *names[] = {"mkl_rt.3.dll", "mkl_rt.2.dll"};
constexpr int openmp_threads = 0; // of Intel, whose library LLVM's code takes too
#else
void *open_library(const char *name) { return dlopen(name, RTLD_NOW | RTLD_LOCAL); }
void *symbol_of(void *handle, const char *name) { return dlsym(handle, name); }
constexpr const char *names[] = {"libmkl_rt.so.3", "libmkl_rt.so.2", "libmkl_rt.so"};
constexpr int openmp_threads = 3; // of GNU
#endif

Library library; // pardiso is null until the library is open

bool open(const char *name) {
    void *handle = open_library(name);
    if (handle == nullptr) return false;
    const auto find = [&]<class Function>(Function &function, const char *symbol) {
        return (function = reinterpret_cast<Function>(symbol_of(handle, symbol))) != nullptr;
    };
    Library found{};
    if (!find(found.pardiso, "pardiso_64") || !find(found.set_threading_layer, "MKL_Set_Threading_Layer") ||
        !find(found.set_threads, "MKL_Set_Num_Threads_Local"))
        return false;
    found.set_threading_layer(openmp_threads);
    library = found;
    return true;
}

class Pardiso final : public Factorisation {
public:
    explicit Pardiso(const SparsePattern &pattern)
        : starts_(pattern.starts().begin(), pattern.starts().end()),
          columns_(pattern.columns().begin(), pattern.columns().end()) {
        settings_[0] = 1;                                           // these settings, not the defaults
        settings_[1] = 2;                                           // nested dissection
        settings_[17] = -1;                                         // count the factor's entries
        settings_[34] = 1;                                          // indices from 0, blocks row by row
        settings_[36] = pattern.block() == 1 ? 0 : pattern.block(); // block CSR
        if (const PardisoIndex error = call(analyse, nullptr); error != 0)
            throw std::runtime_error("pardiso: analysis failed with error " + std::to_string(error));
    }
    ~Pardiso() override { call(release, nullptr); }
    Pardiso(const Pardiso &) = delete;
    Pardiso &operator=(const Pardiso &) = delete;

    bool factor(const SparseMatrix &matrix) override {
        const PardisoIndex error = call(factorise, matrix.values().data());
        if (error != 0 && error != not_definite)
            throw std::runtime_error("pardiso: factorisation failed with error " + std::to_string(error) +
                                     (error == no_memory ? " (out of memory)" : ""));
        return error == 0;
    }

    void solve(View<double> b, std::span<double> x) const override {
        // The interface declares b writable, for a setting that is not used.
        if (const PardisoIndex error = call(substitute, nullptr, const_cast<double *>(b.data()), x.data()); error != 0)
            throw std::runtime_error("pardiso: solution failed with error " + std::to_string(error));
    }

    std::int64_t entries() const override { return settings_[17] * (settings_[36] ? settings_[36] * settings_[36] : 1); }

private:
    static constexpr PardisoIndex analyse = 11, factorise = 22, substitute = 33, release = -1; // phases
    static constexpr PardisoIndex not_definite = -4, no_memory = -2;                           // errors

    PardisoIndex call(PardisoIndex phase, const void *values, double *b = nullptr, double *x = nullptr) const {
        const PardisoIndex one = 1, zero = 0, positive_definite = 2, rows = PardisoIndex(starts_.size()) - 1;
        PardisoIndex error = 0;
        const int before = library.set_threads(omp_get_max_threads());
        library.pardiso(static_cast<void *>(handle_), &one, &one, &positive_definite, &phase, &rows, values, starts_.data(),
                        columns_.data(), nullptr, &one, settings_, &zero, b, x, &error);
        library.set_threads(before);
        return error;
    }

    std::vector<PardisoIndex> starts_, columns_;
    mutable void *handle_[64] = {}; // internal memory of PARDISO
    mutable PardisoIndex settings_[64] = {};
};

} // namespace

bool open_pardiso(const std::string &path) {
    static std::mutex opening;
    const std::lock_guard guard(opening);
    if (library.pardiso != nullptr) return true;
    if (!path.empty()) return open(path.c_str());
    for (const char *name : names)
        if (open(name)) return true;
    return false;
}

bool pardiso_available() { return open_pardiso(); }

std::unique_ptr<Factorisation> make_pardiso(const SparsePattern &pattern) { return std::make_unique<Pardiso>(pattern); }

} // namespace ringlet
