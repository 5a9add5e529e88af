/* The shared library loaded, used on all threads and closed again, as by a plugin. Argument: the library. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fastccd/fastccd.h>

typedef int time_of_impact(int, const double*, size_t, const fastccd_options*, double*, uint8_t*, fastccd_summary*);

int main(int count, char** arguments)
{
    const size_t pairs = 20000;
    double* coordinates = malloc(pairs * 24 * sizeof(double));
    double* toi = malloc(pairs * sizeof(double));
    int round;
    size_t i;
    if (count != 2 || coordinates == NULL || toi == NULL) return 1;
    for (i = 0; i < pairs * 24; ++i) coordinates[i] = rand() / (double)RAND_MAX;
    for (round = 0; round < 20; ++round) {
        void* library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
        void* symbol;
        time_of_impact* call;
        if (library == NULL || (symbol = dlsym(library, "fastccd_pairs_time_of_impact")) == NULL) {
            fprintf(stderr, "%s\n", dlerror());
            return 1;
        }
        memcpy(&call, &symbol, sizeof call); /* C has no other way from an object to a function */
        if (call(FASTCCD_EDGE_EDGE, coordinates, pairs, NULL, toi, NULL, NULL) != FASTCCD_OK) return 1;
        dlclose(library);
        /* It stays: threads of oneTBB, which would go with it, may still be running. */
        library = dlopen(arguments[1], RTLD_NOW | RTLD_NOLOAD);
        if (library == NULL) {
            fputs("the library has left memory\n", stderr);
            return 1;
        }
        dlclose(library);
    }
    free(coordinates);
    free(toi);
    puts("loaded, used and closed 20 times");
    return 0;
}
