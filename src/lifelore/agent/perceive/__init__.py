"""The verbs `perceive`, `scenes` and `learn-relations`.

Read in this order: `perceive`, `perceive_many`, `views`, `cloud_folder`,
`source_files`, `scene_files`, `plan_json`; `perceive_upload`, `scene_bytes`; `scenes`; `learn_relations`.
"""
