/* OpenVDB 10 behind volume_table.h. It takes long to compile, so it is one file.
 *
 * OpenVDB hands work to TBB's threads, which cost processor time even to come and go. Every call
 * here that may do so runs under an iso limit of one thread, lifted at its end, since the limit
 * holds for whoever else uses TBB in the process. */
#include <cmath>
#include <cstdio>
#include <cstring>
#include <istream>
#include <memory>
#include <new>
#include <ostream>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <vector>

#include <openvdb/openvdb.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/DelayedLoadMetadata.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/global_control.h>

#include "solid/volume_table.h"

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::FloatTree;
using openvdb::MaskGrid;
using openvdb::MaskTree;

/* One of the two grids. */
struct volume_grid {
    FloatGrid::Ptr number;
    MaskGrid::Ptr mask;
    std::unique_ptr<FloatGrid::Accessor> number_accessor; /* while it is built */
    std::unique_ptr<MaskGrid::Accessor> mask_accessor;
    double voxel = 1, origin[3] = {0, 0, 0};
    float inside = 0;
};

namespace {

/* What is wrong with the caller's file or wish, as against with OpenVDB. */
struct refusal : std::runtime_error {
    iso_status status;
    refusal(iso_status why, const std::string &text) : std::runtime_error(text), status(why) {}
};

iso_status say(char *message, iso_status status, const char *text) {
    std::snprintf(message, VOLUME_MESSAGE, "%s", text);
    return status;
}

/* Run `work` on one thread and let nothing out. */
template <typename function> iso_status guarded(char *message, iso_status other, function work) {
    try {
        tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        work();
        return ISO_OK;
    } catch (const refusal &thrown) {
        return say(message, thrown.status, thrown.what());
    } catch (const std::bad_alloc &) {
        return say(message, ISO_NO_MEMORY, "out of memory");
    } catch (const std::length_error &) {
        return say(message, ISO_NO_MEMORY, "out of memory");
    } catch (const std::exception &thrown) {
        return say(message, other, thrown.what());
    } catch (...) {
        return say(message, other, "OpenVDB threw something");
    }
}

/* Registers the types of grids, once. The table of leaf sizes that OpenVDB adds to a file for
 * loading it bit by bit is left out: it would compress everything twice. */
void start_openvdb() {
    static const bool started = [] {
        openvdb::initialize();
        openvdb::io::DelayedLoadMetadata::unregisterType();
        return true;
    }();
    (void)started;
}

// Building

iso_status grid_new(volume_grid **result, const volume_form *form, char *message) {
    *result = nullptr;
    return guarded(message, ISO_BUG, [&] {
        start_openvdb();
        std::unique_ptr<volume_grid> grid(new volume_grid);
        grid->voxel = form->voxel;
        grid->inside = form->inside;
        openvdb::GridBase::Ptr base;
        if (form->is_mask) {
            base = grid->mask = MaskGrid::create();
            grid->mask_accessor.reset(new MaskGrid::Accessor(grid->mask->getAccessor()));
        } else {
            base = grid->number = FloatGrid::create(form->outside);
            grid->number_accessor.reset(new FloatGrid::Accessor(grid->number->getAccessor()));
            if (form->is_distance)
                base->setGridClass(openvdb::GRID_LEVEL_SET);
        }
        const openvdb::math::Transform::Ptr transform =
            openvdb::math::Transform::createLinearTransform(form->voxel);
        for (int i = 0; i < 3; i++)
            grid->origin[i] = form->origin[i];
        transform->postTranslate(openvdb::Vec3d(form->origin));
        base->setTransform(transform);
        base->setName(form->name && *form->name ? form->name : "solid");
        *result = grid.release();
    });
}

void grid_free(volume_grid *grid) {
    char message[VOLUME_MESSAGE];
    (void)guarded(message, ISO_BUG, [&] { delete grid; });
}

/* A tile of the size of a block: what holds nothing but one value needs no leaf. */
void put_full(volume_grid *grid, const Coord &first) {
    if (grid->mask)
        grid->mask_accessor->addTile(1, first, true, true);
    else
        grid->number_accessor->addTile(1, first, grid->inside, false);
}

/* OpenVDB counts z fastest. */
inline openvdb::Index leaf_offset(int i) {
    return static_cast<openvdb::Index>((i & 7) << 6 | (i & 0x38) | i >> 6);
}

void put_mask(volume_grid *grid, const Coord &first, const float *value) {
    using leaf_type = MaskTree::LeafNodeType;
    leaf_type::NodeMaskType bits;
    int on = 0;
    /* a word of 64 bits is one x: bit 8 y + z */
    for (int x = 0; x < 8; x++) {
        uint64_t word = 0;
        for (int z = 0; z < 8; z++)
            for (int y = 0; y < 8; y++)
                word |= static_cast<uint64_t>(value[x + 8 * (y + 8 * z)] <= 0) << (8 * y + z);
        bits.getWord<uint64_t>(static_cast<openvdb::Index>(x)) = word;
        on += __builtin_popcountll(word);
    }
    if (on == 0)
        return;
    if (on == VOLUME_CELLS) {
        put_full(grid, first);
        return;
    }
    std::unique_ptr<leaf_type> leaf(new leaf_type(first, false));
    leaf->setValueMask(bits);
    grid->mask_accessor->addLeaf(leaf.get());
    leaf.release();
}

void put_numbers(volume_grid *grid, const Coord &first, const float *value) {
    using leaf_type = FloatTree::LeafNodeType;
    const float outside = grid->number->background(), inside = grid->inside;
    int above = 0, below = 0;
    for (int i = 0; i < VOLUME_CELLS; i++) {
        above += !(value[i] < outside);
        below += value[i] <= inside;
    }
    if (above == VOLUME_CELLS)
        return;
    if (below == VOLUME_CELLS) {
        put_full(grid, first);
        return;
    }
    std::unique_ptr<leaf_type> leaf(new leaf_type(first, outside, false));
    float *buffer = leaf->buffer().data();
    for (int i = 0; i < VOLUME_CELLS; i++) {
        openvdb::Index n = leaf_offset(i);
        if (!(value[i] < outside))
            continue;
        buffer[n] = value[i] <= inside ? inside : value[i];
        if (value[i] > inside)
            leaf->setValueOn(n);
    }
    grid->number_accessor->addLeaf(leaf.get());
    leaf.release();
}

iso_status grid_block(volume_grid *grid, const int32_t first[3], const float *value,
                      char *message) {
    try {
        const Coord corner(first[0], first[1], first[2]);
        if (grid->mask)
            put_mask(grid, corner, value);
        else
            put_numbers(grid, corner, value);
        return ISO_OK;
    } catch (...) {
        return say(message, ISO_NO_MEMORY, "out of memory");
    }
}

iso_status grid_full(volume_grid *grid, const int32_t first[3], char *message) {
    try {
        put_full(grid, Coord(first[0], first[1], first[2]));
        return ISO_OK;
    } catch (...) {
        return say(message, ISO_NO_MEMORY, "out of memory");
    }
}

iso_status grid_finish(volume_grid *grid, char *message) {
    return guarded(message, ISO_BUG, [&] {
        grid->number_accessor.reset();
        grid->mask_accessor.reset();
        if (grid->mask)
            grid->mask->pruneGrid();
        else
            grid->number->pruneGrid();
    });
}

// Reading

/* A file as a stream that throws where it ends: OpenVDB itself goes on with whatever there is. */
class file_buffer : public std::streambuf {
  public:
    explicit file_buffer(const char *path) : file_(std::fopen(path, "rb")) {
        if (!file_ || std::fseek(file_, 0, SEEK_END) != 0 || (size_ = std::ftell(file_)) < 0 ||
            std::fseek(file_, 0, SEEK_SET) != 0) {
            const std::string why = std::strerror(errno);
            if (file_)
                std::fclose(file_);
            throw refusal(ISO_UNREADABLE, "can't be read: " + why);
        }
    }
    file_buffer(const file_buffer &) = delete;
    file_buffer &operator=(const file_buffer &) = delete;
    ~file_buffer() override { std::fclose(file_); }

    /* What comes next: names and the like, or voxels, in blocks that are compressed if not 0. */
    void expect_names() { compression_ = voxels_ = 0; }
    void expect_voxels(uint32_t compression, bool eight_bytes) {
        voxels_ = eight_bytes ? 8 : 4;
        compression_ = compression;
    }

  protected:
    std::streamsize xsgetn(char *bytes, std::streamsize count) override {
        if (count < 0 || count > size_ - position_)
            throw refusal(ISO_UNREADABLE, "ends too early; it is cut off or damaged");
        if (std::fread(bytes, 1, static_cast<size_t>(count), file_) != static_cast<size_t>(count))
            throw refusal(ISO_UNREADABLE, "can't be read to its end");
        position_ += count;
        check_block(bytes, count);
        return count;
    }

    int_type underflow() override {
        if (position_ >= size_)
            throw refusal(ISO_UNREADABLE, "ends too early; it is cut off or damaged");
        const int next = std::fgetc(file_);
        std::ungetc(next, file_);
        return next;
    }

    int_type uflow() override {
        const int_type next = underflow();
        std::fgetc(file_);
        position_++;
        last_count_ = 1;
        return next;
    }

    pos_type seekoff(off_type offset, std::ios_base::seekdir way,
                     std::ios_base::openmode) override {
        off_type to = offset;
        if (way == std::ios_base::cur)
            to += position_;
        else if (way == std::ios_base::end)
            to += size_;
        if (to == position_)
            return to;
        if (to < 0 || to > size_ || std::fseek(file_, static_cast<long>(to), SEEK_SET) != 0)
            throw refusal(ISO_UNREADABLE, "points beyond its end; it is cut off or damaged");
        position_ = to;
        last_count_ = 0;
        return to;
    }

    pos_type seekpos(pos_type to, std::ios_base::openmode mode) override {
        return seekoff(off_type(to), std::ios_base::beg, mode);
    }

  private:
    static void refuse_size() {
        throw refusal(ISO_UNREADABLE, "has a block of the wrong size; it is damaged");
    }

    /* OpenVDB takes memory for as many bytes as it is told to come. So sizes of what can't be there
     * are found here: of a text, 4 bytes (4 bytes after a size of 4 are a number), and of a
     * compressed block, 8 bytes where no voxel has as many. */
    void check_size(const char *bytes, std::streamsize count) {
        uint32_t text = 0;
        if (voxels_ == 0 && count == 4) {
            std::memcpy(&text, bytes, 4);
            if (!last_was_four_ && text > size_ - position_)
                refuse_size();
        }
        last_was_four_ = text == 4;
        constexpr uint32_t compressed = openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ZIP;
        if (voxels_ == 4 && count == 8 && (compression_ & compressed)) {
            int64_t block = 0;
            std::memcpy(&block, bytes, 8);
            if (block > size_ - position_)
                refuse_size();
        }
    }

    /* Blosc believes the size that a compressed block's own head gives and would read on beyond its
     * end: it must be equal to the size before the block. */
    void check_block(const char *bytes, std::streamsize count) {
        check_size(bytes, count);
        if (last_count_ == 8 && last_value_ == count &&
            (compression_ & openvdb::io::COMPRESS_BLOSC)) {
            int32_t own = -1;
            if (count >= 16)
                std::memcpy(&own, bytes + 12, sizeof own);
            if (own != count)
                refuse_size();
        }
        last_count_ = count;
        if (count == 8)
            std::memcpy(&last_value_, bytes, 8);
    }

    std::FILE *file_;
    std::streamoff size_ = 0, position_ = 0;
    std::streamsize last_count_ = 0;
    int64_t last_value_ = 0;
    bool last_was_four_ = false;
    int voxels_ = 0; /* bytes of each; 0: names */
    uint32_t compression_ = 0;
};

bool is_known(const std::string &type) {
    return type == FloatGrid::gridType() || type == openvdb::DoubleGrid::gridType() ||
           type == openvdb::Int32Grid::gridType() || type == openvdb::Int64Grid::gridType() ||
           type == openvdb::BoolGrid::gridType() || type == MaskGrid::gridType();
}

/* The reading half of OpenVDB's io::File, on a stream of ours and step by step. */
class reader : public openvdb::io::Archive {
  public:
    explicit reader(file_buffer *buffer) : buffer_(buffer), stream_(buffer) {
        stream_.exceptions(std::ios_base::badbit | std::ios_base::failbit | std::ios_base::eofbit);
    }

    openvdb::GridBase::Ptr read(const char *name) {
        read_head();
        std::string others;
        for (int32_t left = readGridCount(stream_); left > 0; left--)
            if (openvdb::GridBase::Ptr grid = next(others, name))
                return grid;
        if (name)
            throw refusal(ISO_UNREADABLE, std::string("has no grid of numbers \"") + name +
                                              "\", but " + (others.empty() ? "none" : others));
        throw refusal(ISO_UNREADABLE, "has no grid of numbers, but " +
                                          (others.empty() ? std::string("none at all") : others));
    }

  private:
    void read_head() {
        int64_t magic = 0;
        uint32_t version = 0;
        stream_.read(reinterpret_cast<char *>(&magic), sizeof magic);
        if (magic != openvdb::OPENVDB_MAGIC)
            throw refusal(ISO_UNREADABLE, "is no .vdb file");
        stream_.read(reinterpret_cast<char *>(&version), sizeof version);
        if (version > openvdb::OPENVDB_FILE_VERSION ||
            version < openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION)
            throw refusal(ISO_UNREADABLE,
                          "is of format " + std::to_string(version) + "; only 222 to " +
                              std::to_string(openvdb::OPENVDB_FILE_VERSION) + " are understood");
        stream_.seekg(0);
        facts_.reset(new openvdb::io::StreamMetadata);
        openvdb::io::setStreamMetadataPtr(stream_, facts_, false);
        readHeader(stream_);
        setFormatVersion(stream_);
        setLibraryVersion(stream_);
        setDataCompression(stream_);
        openvdb::MetaMap().readMeta(stream_);
    }

    openvdb::GridBase::Ptr next(std::string &others, const char *name) {
        openvdb::io::GridDescriptor descriptor;
        const std::streamoff start = stream_.tellg();
        openvdb::GridBase::Ptr grid = descriptor.read(stream_);
        const std::string own = descriptor.gridName(), type = descriptor.gridType();
        const bool wanted = grid && is_known(type) && (!name || own == name);
        if (wanted && descriptor.isInstance())
            throw refusal(ISO_UNREADABLE, "grid \"" + own + "\" has its values in \"" +
                                              descriptor.instanceParentName() +
                                              "\"; name that one");
        if (others.size() < 200)
            others += (others.empty() ? "\"" : ", \"") + own + "\" (" + type + ")";
        if (!wanted && inputHasGridOffsets()) {
            if (descriptor.getEndPos() <= start)
                throw refusal(ISO_UNREADABLE, "is damaged");
            descriptor.seekToEnd(stream_);
            return nullptr;
        }
        if (!grid || !is_known(type))
            throw refusal(ISO_UNREADABLE,
                          "grid \"" + own + "\" is of type " + type + " and can't be passed over");
        if (inputHasGridOffsets())
            descriptor.seekToGrid(stream_);
        read_grid(grid.get(), type);
        return wanted ? grid : nullptr;
    }

    void read_grid(openvdb::GridBase *grid, const std::string &type) {
        readGridCompression(stream_);
        facts_.reset(new openvdb::io::StreamMetadata(*facts_));
        facts_->setHalfFloat(grid->saveFloatAsHalf());
        openvdb::io::setStreamMetadataPtr(stream_, facts_, false);
        openvdb::io::setGridClass(stream_, openvdb::GRID_UNKNOWN);
        openvdb::io::setGridBackgroundValuePtr(stream_, nullptr);
        grid->readMeta(stream_);
        openvdb::io::setGridClass(stream_, grid->getGridClass());
        grid->readTransform(stream_);
        int32_t buffers = 0;
        const std::streamoff start = stream_.tellg();
        stream_.read(reinterpret_cast<char *>(&buffers), sizeof buffers);
        if (buffers != 1)
            throw refusal(ISO_UNREADABLE, "has more than one value in a voxel, or is damaged");
        stream_.seekg(start);
        buffer_->expect_voxels(openvdb::io::getDataCompression(stream_),
                               type == openvdb::DoubleGrid::gridType() ||
                                   type == openvdb::Int64Grid::gridType());
        grid->readTopology(stream_);
        grid->readBuffers(stream_);
        buffer_->expect_names();
    }

    file_buffer *buffer_;
    std::istream stream_;
    openvdb::io::StreamMetadata::Ptr facts_;
};

template <typename grid_type> FloatGrid::Ptr numbers(const openvdb::GridBase::Ptr &base) {
    const typename grid_type::Ptr from = openvdb::gridPtrCast<grid_type>(base);
    return FloatGrid::create(FloatTree::Ptr(new FloatTree(from->tree())));
}

/* On where the value is true, whether OpenVDB takes it for active or not. */
MaskGrid::Ptr mask_of(const openvdb::GridBase::Ptr &base) {
    const openvdb::BoolGrid::Ptr from = openvdb::gridPtrCast<openvdb::BoolGrid>(base);
    if (from->background())
        throw refusal(ISO_UNREADABLE, "its grid is true everywhere outside");
    MaskGrid::Ptr mask = MaskGrid::create();
    MaskTree &tree = mask->tree();
    for (auto i = from->cbeginValueAll(); i; ++i) {
        if (!*i)
            continue;
        if (i.isVoxelValue())
            tree.setValueOn(i.getCoord());
        else
            tree.addTile(i.getLevel(), i.getCoord(), true, true);
    }
    return mask;
}

void take_transform(volume_grid *grid, const openvdb::math::Transform &transform) {
    if (!transform.isLinear())
        throw refusal(ISO_UNREADABLE, "its grid tapers; only cubic voxels are understood");
    const openvdb::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
    const double voxel = matrix(0, 0);
    bool fits = voxel > 1e-9 && voxel < 1e9;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            fits = fits && std::fabs(matrix(i, j) - (i == j ? voxel : 0)) <= 1e-9 * voxel;
        grid->origin[i] = matrix(3, i);
        fits = fits && std::fabs(grid->origin[i]) < 1e9;
    }
    if (!fits)
        throw refusal(ISO_UNREADABLE, "its grid is turned, mirrored, sheared or stretched; only "
                                      "cubic voxels along the axes are understood");
    grid->voxel = voxel;
}

iso_status grid_read(volume_grid **result, const char *path, const char *name, char *message) {
    *result = nullptr;
    return guarded(message, ISO_UNREADABLE, [&] {
        start_openvdb();
        file_buffer buffer(path);
        openvdb::GridBase::Ptr base = reader(&buffer).read(name);
        std::unique_ptr<volume_grid> grid(new volume_grid);
        take_transform(grid.get(), base->transform());
        const std::string type = base->type();
        if (type == FloatGrid::gridType())
            grid->number = openvdb::gridPtrCast<FloatGrid>(base);
        else if (type == openvdb::DoubleGrid::gridType())
            grid->number = numbers<openvdb::DoubleGrid>(base);
        else if (type == openvdb::Int32Grid::gridType())
            grid->number = numbers<openvdb::Int32Grid>(base);
        else if (type == openvdb::Int64Grid::gridType())
            grid->number = numbers<openvdb::Int64Grid>(base);
        else if (type == openvdb::BoolGrid::gridType())
            grid->mask = mask_of(base);
        else
            grid->mask = openvdb::gridPtrCast<MaskGrid>(base);
        if (grid->number && grid->number != base) {
            grid->number->setGridClass(base->getGridClass());
            grid->number->setName(base->getName());
            grid->number->setTransform(base->transform().copy());
        } else if (grid->mask && grid->mask != base) {
            grid->mask->setName(base->getName());
            grid->mask->setTransform(base->transform().copy());
        }
        *result = grid.release();
    });
}

// Writing

/* Counts and hashes what goes to the sink. */
class sink_buffer : public std::streambuf {
  public:
    explicit sink_buffer(const volume_sink *sink) : sink_(sink) {}
    uint64_t hash(int i) const { return hash_[i]; }

  protected:
    std::streamsize xsputn(const char *bytes, std::streamsize count) override {
        if (sink_->write(sink_->payload, position_, bytes, static_cast<size_t>(count)) != 0)
            throw refusal(ISO_NOT_WRITTEN, "");
        /* the head has a random number in it, and patches are places of things hashed before */
        if (position_ >= head && position_ == size_)
            mix(bytes, static_cast<size_t>(count));
        position_ += count;
        if (size_ < position_)
            size_ = position_;
        return count;
    }

    int_type overflow(int_type value) override {
        const char byte = static_cast<char>(value);
        xsputn(&byte, 1);
        return value;
    }

    pos_type seekoff(off_type offset, std::ios_base::seekdir way,
                     std::ios_base::openmode) override {
        if (way == std::ios_base::cur)
            offset += position_;
        else if (way == std::ios_base::end)
            offset += size_;
        if (offset < 0 || offset > size_)
            throw refusal(ISO_BUG, "OpenVDB seeks beyond its file");
        position_ = offset;
        return position_;
    }

    pos_type seekpos(pos_type to, std::ios_base::openmode mode) override {
        return seekoff(off_type(to), std::ios_base::beg, mode);
    }

  public:
    static const std::streamoff head = 57, unique = 21; /* magic number, versions; 36 letters */

  private:
    void mix(const char *bytes, size_t count) {
        uint64_t a = hash_[0], b = hash_[1] + count, word;
        for (; count >= 8; bytes += 8, count -= 8) {
            std::memcpy(&word, bytes, 8);
            a = (a ^ word) * UINT64_C(0x9e3779b97f4a7c15);
            a ^= a >> 32;
            b = (b + a) * UINT64_C(0xd6e8feb86659fd93);
        }
        word = 0;
        std::memcpy(&word, bytes, count);
        a = (a ^ word) * UINT64_C(0x9e3779b97f4a7c15);
        hash_[0] = a ^ a >> 29;
        hash_[1] = (b + a) * UINT64_C(0xd6e8feb86659fd93);
    }

    const volume_sink *sink_;
    std::streamoff position_ = 0, size_ = 0;
    uint64_t hash_[2] = {UINT64_C(0x243f6a8885a308d3), UINT64_C(0x13198a2e03707344)};
};

class writer : public openvdb::io::Archive {
  public:
    void write_to(std::ostream &stream, const openvdb::GridBase::ConstPtr &grid) const {
        openvdb::GridCPtrVec grids;
        grids.push_back(grid);
        Archive::write(stream, grids, true);
    }
    void write(const openvdb::GridCPtrVec &, const openvdb::MetaMap &) const override {}
};

/* OpenVDB tags a file with a random number, so that who loads it later bit by bit sees that it was
 * replaced. A hash of what is in it serves that end too, and equal grids give equal files. */
void put_unique(const sink_buffer &buffer, const volume_sink *sink) {
    char text[37];
    const unsigned long long a = buffer.hash(0), b = buffer.hash(1);
    std::snprintf(text, sizeof text, "%08llx-%04llx-8%03llx-%04llx-%012llx", a >> 32,
                  a >> 16 & 0xffff, a & 0xfff, (b >> 48 & 0x3fff) | 0x8000,
                  b & UINT64_C(0xffffffffffff));
    if (sink->write(sink->payload, sink_buffer::unique, text, 36) != 0)
        throw refusal(ISO_NOT_WRITTEN, "");
}

iso_status grid_write(const volume_grid *grid, const volume_sink *sink, char *message) {
    return guarded(message, ISO_NOT_WRITTEN, [&] {
        sink_buffer buffer(sink);
        std::ostream stream(&buffer);
        stream.exceptions(std::ios_base::badbit | std::ios_base::failbit);
        if (grid->mask)
            writer().write_to(stream, grid->mask);
        else
            writer().write_to(stream, grid->number);
        put_unique(buffer, sink);
    });
}

// Asking

iso_status grid_facts(volume_facts *facts, const volume_grid *grid, char *message) {
    return guarded(message, ISO_BUG, [&] {
        openvdb::GridBase::ConstPtr base;
        if (grid->mask)
            base = grid->mask;
        else
            base = grid->number;
        for (int i = 0; i < 3; i++)
            facts->origin[i] = grid->origin[i];
        facts->voxel = grid->voxel;
        facts->background = grid->mask ? 0 : static_cast<double>(grid->number->background());
        const openvdb::CoordBBox box = base->evalActiveVoxelBoundingBox();
        for (int i = 0; i < 3; i++) {
            facts->min[i] = box.min()[i];
            facts->max[i] = box.max()[i];
        }
        facts->active = static_cast<int64_t>(base->activeVoxelCount());
        facts->bytes = static_cast<int64_t>(base->memUsage());
        facts->is_mask = grid->mask != nullptr;
        facts->is_distance = base->getGridClass() == openvdb::GRID_LEVEL_SET;
    });
}

template <typename accessor_type>
void eight_values(double *value, const accessor_type &accessor, const int32_t *first) {
    for (int i = 0; i < 8; i++) {
        const Coord at(first[0] + (i & 1), first[1] + (i >> 1 & 1), first[2] + (i >> 2));
        value[i] = static_cast<double>(accessor.getValue(at));
    }
}

/* Two in three times all of them are in one leaf, which is then looked for once. */
void eight_values(double *value, const FloatGrid::ConstUnsafeAccessor &accessor,
                  const int32_t *first) {
    const FloatTree::LeafNodeType *leaf = nullptr;
    if ((first[0] & 7) < 7 && (first[1] & 7) < 7 && (first[2] & 7) < 7)
        leaf = accessor.probeConstLeaf(Coord(first[0], first[1], first[2]));
    if (!leaf) {
        eight_values<FloatGrid::ConstUnsafeAccessor>(value, accessor, first);
        return;
    }
    const float *at =
        leaf->buffer().data() + ((first[0] & 7) << 6 | (first[1] & 7) << 3 | (first[2] & 7));
    for (int i = 0; i < 8; i++)
        value[i] = static_cast<double>(at[(i & 1) << 6 | (i & 2) << 2 | i >> 2]);
}

template <typename accessor_type>
double trilinear(const accessor_type &accessor, const volume_grid *grid, const double *point,
                 double background) {
    double part[3];
    int32_t first[3];
    for (int i = 0; i < 3; i++) {
        const double index = (point[i] - grid->origin[i]) / grid->voxel;
        if (!(index > -2e9 && index < 2e9))
            return background;
        const double below = std::floor(index);
        first[i] = static_cast<int32_t>(below);
        part[i] = index - below;
    }
    double sum[4], end[8];
    eight_values(end, accessor, first);
    for (int i = 0; i < 4; i++)
        sum[i] = end[2 * i] + (end[2 * i + 1] - end[2 * i]) * part[0];
    const double low = sum[0] + (sum[1] - sum[0]) * part[1];
    const double high = sum[2] + (sum[3] - sum[2]) * part[1];
    return low + (high - low) * part[2];
}

iso_status grid_sample(double *value, const volume_grid *grid, const double *point, int64_t count,
                       char *message) {
    try {
        if (grid->mask) {
            /* not registered with the tree: that would be a lock */
            const MaskGrid::ConstUnsafeAccessor accessor(grid->mask->getConstUnsafeAccessor());
            for (int64_t i = 0; i < count; i++)
                value[i] = trilinear(accessor, grid, point + 3 * i, 0);
        } else {
            const FloatGrid::ConstUnsafeAccessor accessor(grid->number->getConstUnsafeAccessor());
            const double background = static_cast<double>(grid->number->background());
            for (int64_t i = 0; i < count; i++)
                value[i] = trilinear(accessor, grid, point + 3 * i, background);
        }
        return ISO_OK;
    } catch (...) {
        return say(message, ISO_BUG, "OpenVDB threw something");
    }
}

// Surface

/* Where values are `level` exactly, faces shrink to edges: such a triangle is left out, and those
 * beside it fit together without it. */
float *put_triangle(float *corner, const openvdb::Vec3s &a, const openvdb::Vec3s &b,
                    const openvdb::Vec3s &c) {
    if (a == b || b == c || c == a)
        return corner;
    for (int i = 0; i < 3; i++) {
        corner[i] = a[i];
        corner[3 + i] = b[i];
        corner[6 + i] = c[i];
    }
    return corner + 9;
}

/* OpenVDB's faces turn clockwise, seen from outside. Quads are cut along the shorter diagonal. */
float *put_quad(float *corner, const std::vector<openvdb::Vec3s> &points, const openvdb::Vec4I &q) {
    const openvdb::Vec3s &a = points[q[3]], &b = points[q[2]], &c = points[q[1]], &d = points[q[0]];
    if ((c - a).lengthSqr() <= (d - b).lengthSqr())
        return put_triangle(put_triangle(corner, a, b, c), a, c, d);
    return put_triangle(put_triangle(corner, a, b, d), b, c, d);
}

iso_status grid_surface(volume_triangles *triangles, const volume_grid *grid, double level,
                        char *message) {
    triangles->corner = nullptr;
    triangles->count = 0;
    return guarded(message, ISO_BUG, [&] {
        std::vector<openvdb::Vec3s> points;
        std::vector<openvdb::Vec3I> left; /* none: nothing is merged */
        std::vector<openvdb::Vec4I> quads;
        /* OpenVDB takes what isn't a level set by its own account for fog, full of large values */
        bool is_fog = false;
        if (grid->mask) {
            FloatGrid::Ptr half = FloatGrid::create(FloatTree::Ptr(
                new FloatTree(grid->mask->tree(), 1.0f, -1.0f, openvdb::TopologyCopy())));
            half->setTransform(grid->mask->transform().copy());
            half->setGridClass(openvdb::GRID_LEVEL_SET);
            openvdb::tools::volumeToMesh(*half, points, left, quads, 0.0);
        } else {
            is_fog = grid->number->getGridClass() != openvdb::GRID_LEVEL_SET;
            openvdb::tools::volumeToMesh(*grid->number, points, left, quads, level);
        }
        const size_t count = 2 * quads.size() + left.size();
        float *corner = static_cast<float *>(triangles->allocate(count * 9 * sizeof(float)));
        if (!corner)
            throw std::bad_alloc();
        float *end = corner;
        for (const openvdb::Vec4I &q : quads)
            end = put_quad(end, points, is_fog ? openvdb::Vec4I(q[3], q[2], q[1], q[0]) : q);
        for (const openvdb::Vec3I &t : left)
            end = put_triangle(end, points[t[is_fog ? 0 : 2]], points[t[1]],
                               points[t[is_fog ? 2 : 0]]);
        triangles->corner = corner;
        triangles->count = (end - corner) / 9;
    });
}

} // namespace

MODULE_TABLE const volume_table isoslice_module = {{MODULE_VERSION_VOLUME},
                                                   grid_new,
                                                   grid_free,
                                                   grid_block,
                                                   grid_full,
                                                   grid_finish,
                                                   grid_read,
                                                   grid_write,
                                                   grid_facts,
                                                   grid_sample,
                                                   grid_surface,
                                                   volume_picture_read};
