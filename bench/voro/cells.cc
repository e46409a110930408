// Cuts Voronoi cells with voro++ (https://math.lbl.gov/voro++), on command and timed by the processor time of this thread.
//
// Standard input: the number of cells; for each cell its box, relative to the site (x low, x high, y low, y high, z low,
// z high), the number of cuts and for each cut a vector and twice the offset: the half-space v·x <= rsq/2. Then commands:
//   volumes   one line with the volume of every cell
//   run N     cuts all cells N times and prints the nanoseconds this took
#include <cstdio>
#include <cstring>
#include <ctime>
#include <vector>
#include <voro++/voro++.hh>

struct Cut {
    double x, y, z, rsq;
};

struct Cell {
    double box[6];
    std::vector<Cut> cuts;
};

static bool read_cells(std::vector<Cell> &cells) {
    size_t count;
    if (std::scanf("%zu", &count) != 1) return false;
    cells.resize(count);
    for (Cell &cell : cells) {
        for (double &bound : cell.box)
            if (std::scanf("%lf", &bound) != 1) return false;
        size_t cuts;
        if (std::scanf("%zu", &cuts) != 1) return false;
        cell.cuts.resize(cuts);
        for (Cut &cut : cell.cuts)
            if (std::scanf("%lf %lf %lf %lf", &cut.x, &cut.y, &cut.z, &cut.rsq) != 4) return false;
    }
    return true;
}

static void build(voro::voronoicell &voronoi, const Cell &cell) {
    const double *b = cell.box;
    voronoi.init(b[0], b[1], b[2], b[3], b[4], b[5]);
    for (const Cut &cut : cell.cuts) voronoi.plane(cut.x, cut.y, cut.z, cut.rsq);
}

static long long nanoseconds() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return now.tv_sec * 1000000000LL + now.tv_nsec;
}

int main() {
    std::vector<Cell> cells;
    if (!read_cells(cells)) return 1;
    // One cell object for all, as in voro++'s own container loops: its memory is allocated once.
    voro::voronoicell voronoi;
    char command[16];
    while (std::scanf("%15s", command) == 1) {
        if (!std::strcmp(command, "volumes")) {
            for (const Cell &cell : cells) {
                build(voronoi, cell);
                std::printf("%.17g ", voronoi.volume());
            }
            std::printf("\n");
        } else {
            int rounds;
            if (std::scanf("%d", &rounds) != 1) return 1;
            // The vertex counts are summed and returned so that no cell can be optimised away.
            long long vertices = 0, start = nanoseconds();
            for (int round = 0; round < rounds; round++)
                for (const Cell &cell : cells) {
                    build(voronoi, cell);
                    vertices += voronoi.p;
                }
            std::printf("%lld %lld\n", nanoseconds() - start, vertices);
        }
        std::fflush(stdout);
    }
}
