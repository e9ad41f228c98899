// Whether the samples are the hits of other samples' rays, in place of what the camera sees. Pipelines are compiled for it.

override AT_HITS: bool = false;
