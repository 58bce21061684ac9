// Reads clouds of points, "m n" and then the coordinates, and writes for each the seconds and the shape matrix and centre of
// CGAL's Approximate_min_ellipsoid_d:
//     g++ -O2 -o target/cgal_ellipsoid benches/peers/cgal_ellipsoid.cpp -lgmp -lmpfr
#include <CGAL/Approximate_min_ellipsoid_d.h>
#include <CGAL/Approximate_min_ellipsoid_d_traits_d.h>
#include <CGAL/Cartesian_d.h>
#include <CGAL/MP_Float.h>
#include <chrono>
#include <cstdio>
#include <vector>

typedef CGAL::Cartesian_d<double> Kernel;
typedef CGAL::Approximate_min_ellipsoid_d_traits_d<Kernel, CGAL::MP_Float> Traits;
typedef CGAL::Approximate_min_ellipsoid_d<Traits> Ellipsoid;

int main() {
    int m, n;
    while (std::scanf("%d %d", &m, &n) == 2) {
        std::vector<Traits::Point> points;
        for (int k = 0; k < m; k++) {
            std::vector<double> x(n);
            for (double &c : x) if (std::scanf("%lf", &c) != 1) return 1;
            points.push_back(Traits::Point(n, x.begin(), x.end()));
        }
        const Traits traits;
        double least = 1e9;
        for (int run = 0; run < 7; run++) {
            auto start = std::chrono::steady_clock::now();
            Ellipsoid ellipsoid(0.01, points.begin(), points.end(), traits);
            double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            if (seconds < least) least = seconds;
        }
        // x'Mx + m'x + mu <= 0 for all points.
        Ellipsoid ellipsoid(0.01, points.begin(), points.end(), traits);
        std::printf("%.9g", least);
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) std::printf(" %.17g", ellipsoid.defining_matrix(i, j));
        for (int i = 0; i < n; i++) std::printf(" %.17g", ellipsoid.defining_vector(i));
        std::printf(" %.17g\n", ellipsoid.defining_scalar());
    }
}
