# Pliant on a bare Debian 12. From the root of the checkout:
#
#   docker build -t pliant .
#   docker run --rm pliant                     ./dev demo: installs, builds, deforms a bunny and a liver, compares the bits
#   docker run --rm pliant ./dev test          every test, with several compilers, sanitizers and fuzzers
#
# To keep what the demo writes: docker run --rm -v "$PWD/out:/pliant/out" pliant
# Both commands install their packages when they run, so the image itself is only Debian and the sources.
FROM debian:12
ENV DEBIAN_FRONTEND=noninteractive
WORKDIR /pliant
COPY . .
CMD ["./dev", "demo"]
