// The version that was found is the version that runs.
#include <triptych/triptych.h>

#include <iostream>

int main() {
    std::cout << trp_version() << '\n';
    return trp_version() == TRP_VERSION && trp_method_count() > 0 ? 0 : 1;
}
