# The command with its configurations: docker build -t saccade . && docker run --rm -v "$PWD:/data" saccade simulate walls -o walls
FROM debian:12 AS build
RUN apt-get update -q && apt-get install -q -y --no-install-recommends ca-certificates git
COPY . /source
WORKDIR /source
RUN ./dev package --no-docs

FROM debian:12
COPY --from=build /source/build/package/*.deb /tmp/packages/
RUN apt-get update -q \
  && apt-get install -q -y --no-install-recommends /tmp/packages/saccade_*.deb /tmp/packages/python3-saccade_*.deb ffmpeg \
  && rm -rf /tmp/packages /var/lib/apt/lists/*
WORKDIR /data
ENTRYPOINT ["saccade"]
