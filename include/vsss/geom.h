// Plane geometry shared by all modules.
#ifndef VSSS_GEOM_H
#define VSSS_GEOM_H

#define VS_PI 3.14159265358979323846

#ifdef __cplusplus
extern "C" {
#endif

double vs_wrap_rad(double angle_rad); // into (-pi, pi]
double vs_clamp(double value, double low, double high);
double vs_distance_m(double ax_m, double ay_m, double bx_m, double by_m);

#ifdef __cplusplus
}
#endif
#endif
