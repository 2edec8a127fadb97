"""The page /study: traffic, uplift, policies, alarms and single users of a study of personalisation."""
