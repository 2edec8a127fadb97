"""The page /see: a point cloud in 3-D with its objects, contacts and relations."""
