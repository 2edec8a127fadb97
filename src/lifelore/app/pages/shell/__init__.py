"""What all pages share: frame, navigation, style sheet, and the script that asks the service."""
